"""slipstick.study and gate with an executor: each run is a call of its own; results are those of one command."""
import importlib.util
import os
import signal
import tempfile
import threading
import time
import unittest
from concurrent.futures import BrokenExecutor, Future, ProcessPoolExecutor
from pathlib import Path

import scenes
import slipstick
from slipstick._scene import toml_text


def numbers(study):
    """The orders of a study, without times."""
    return {name: series.order for name, series in study.series.items()}


class CountingExecutor(ProcessPoolExecutor):
    def __init__(self):
        super().__init__(2)
        self.calls = 0

    def submit(self, *words, **named) -> Future:
        self.calls += 1
        return super().submit(*words, **named)


class ExecutorTest(unittest.TestCase):
    def setUp(self):
        self.folder = Path(self.enterContext(tempfile.TemporaryDirectory()))
        (self.folder / "scene.toml").write_text(toml_text(scenes.SPHERE))
        (self.folder / "study.toml").write_text('name = "small"\nscene = "scene.toml"\ncells = [12, 16, 24]\n')
        (self.folder / "gates.toml").write_text('[[gate]]\nid = "tight"\nscene = "scene.toml"\nset = { "grid.cells" = [16, 16] }\n'
                                                'quantity = "twist_error"\nbelow = 1e-9\nbasis = "made up"\n')

    def test_processes(self):
        said = []
        with CountingExecutor() as executor:
            study = slipstick.study(self.folder / "study.toml", output=self.folder / "kept", executor=executor, progress=said.append)
            solved = len(list((self.folder / "kept").glob("*.json")))
            self.assertEqual(executor.calls, solved)
            self.assertIn(f"{solved} of {solved} runs", said)
            again = slipstick.study(self.folder / "study.toml", output=self.folder / "kept", executor=executor)
            self.assertEqual(executor.calls, solved)
            gates = slipstick.gate(self.folder / "gates.toml", executor=executor)
            self.assertEqual(executor.calls, solved + 4)  # a failed gate asks for the parts of its error
        alone = slipstick.study(self.folder / "study.toml")
        for other in (again, alone):
            self.assertEqual(numbers(study), numbers(other))
        self.assertFalse(gates.passed)

    def test_the_current_folder_counts(self):
        here = os.getcwd()
        self.addCleanup(os.chdir, here)
        with ProcessPoolExecutor(1) as executor:
            executor.submit(os.getcwd).result()  # its process stays here
            os.chdir(self.folder)
            slipstick.gate("gates.toml", output="kept", executor=executor)
        self.assertEqual(len(list((self.folder / "kept").glob("*.json"))), 4)

    def test_an_executor_that_fails_is_an_error(self):
        with ProcessPoolExecutor(1) as executor:
            os.kill(executor.submit(os.getpid).result(), signal.SIGKILL)
            with self.assertRaises(BrokenExecutor):
                slipstick.study(self.folder / "study.toml", executor=executor)

    @unittest.skipUnless(importlib.util.find_spec("distributed"), "dask.distributed is not installed")
    def test_a_killed_dask_worker_loses_nothing(self):
        from distributed import Client, LocalCluster

        with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster, Client(cluster) as client:
            victim = next(iter(client.run(os.getpid).values()))

            def kill():
                while not any((self.folder / "kept").glob("*.json")):
                    time.sleep(0.01)
                os.kill(victim, signal.SIGKILL)

            killer = threading.Thread(target=kill)
            killer.start()
            study = slipstick.study(self.folder / "study.toml", output=self.folder / "kept", executor=client.get_executor())
            killer.join()
        self.assertEqual(study.failed_runs.count, 0)
        self.assertEqual(numbers(study), numbers(slipstick.study(self.folder / "study.toml")))
