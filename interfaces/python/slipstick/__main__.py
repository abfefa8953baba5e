"""python -m slipstick: the program."""
from ._program import main

main()
