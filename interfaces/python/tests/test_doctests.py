"""Every example in the package's doc comments gives the shown output."""
import doctest
import pkgutil

import slipstick


def load_tests(_loader, tests, _pattern):
    for module in pkgutil.iter_modules(slipstick.__path__, "slipstick."):
        if not module.name.endswith("__main__"):
            tests.addTests(doctest.DocTestSuite(module.name, optionflags=doctest.NORMALIZE_WHITESPACE))
    assert sum(len(case._dt_test.examples) for case in tests) >= 20
    return tests
