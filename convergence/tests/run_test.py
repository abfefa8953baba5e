"""run_test.py TEST.py WORDS...: runs the cases of a file, which reads WORDS in sys.argv, and finds modules here and beside it."""
import sys
import unittest
from pathlib import Path

sys.argv.pop(0)
sys.path.insert(0, str(Path(sys.argv[0]).resolve().parent))
unittest.main(module=Path(sys.argv[0]).stem, argv=sys.argv[:1])
