"""Every example in the package's doc comments gives the shown output."""
import doctest
import importlib
import pkgutil
import sys

import slipstick

failed = attempted = 0
for module in pkgutil.iter_modules(slipstick.__path__, "slipstick."):
    if module.name.endswith("__main__"):
        continue
    results = doctest.testmod(importlib.import_module(module.name), optionflags=doctest.NORMALIZE_WHITESPACE)
    failed, attempted = failed + results.failed, attempted + results.attempted
print(f"{attempted} examples, {failed} fail")
sys.exit(1 if failed or attempted < 20 else 0)
