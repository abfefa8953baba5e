"""run_test.py TEST.py WORDS...: runs the cases of a file. The file reads WORDS in sys.argv; it imports modules of its folder and of
this one."""
import sys
import unittest
from pathlib import Path

sys.argv.pop(0)
sys.path.insert(0, str(Path(sys.argv[0]).resolve().parent))
result = unittest.main(module=Path(sys.argv[0]).stem, argv=sys.argv[:1], exit=False).result
for _, reason in result.skipped:
    print(f"SKIPPED: {reason}")
sys.exit(not (result.wasSuccessful() and (result.testsRun or result.skipped)))  # a file without cases fails
