#!/usr/bin/python3
"""scripts/slurm on a real Slurm, of four nodes on this machine: nodes die, tasks are requeued, their time runs out, and
the data set is still the one that a single process makes.

  array_test.py SHIMMER
"""

import hashlib
import json
import pathlib
import re
import signal
import subprocess
import sys
import unittest

sys.dont_write_bytecode = True

from cluster import Cluster, wait_for, what_is_missing

SCRIPTS = pathlib.Path(__file__).resolve().parents[2] / "scripts" / "slurm"
PROGRAM, CLUSTER = None, None  # of this run
SKIPPED = 77
SECONDS = 285  # less than ctest gives it

# Exact blurring, so that a task works for some seconds.
CONFIG = {
    "seed": 5, "clips": 160, "frames": 4, "size": [256, 192],
    "source": {"drawn": {"choice": ["chart", "bricks", "text", "star", "stripes"]}},
    "tilt": {"strength_px": {"uniform": [2, 8]}},
    "blur": {"max_sigma_px": {"uniform": [2, 6]}, "method": "exact"},
    "accuracy": {"max_error_px": 0, "max_error_levels": 0},
}
ENDED = {"COMPLETED", "FAILED", "CANCELLED", "TIMEOUT", "NODE_FAIL", "OUT_OF_MEMORY"}


def clips_of(folder):
    """By number: what the manifest says of its files."""
    lines = map(json.loads, (folder / "manifest.jsonl").read_text().splitlines())
    return {line["clip"]: (line["status"], line["files"]) for line in lines}


def files_of(folder):
    """By name: the hash of every file that belongs to a clip. Names alone of the others."""
    def hash_of(path):
        return hashlib.sha256(path.read_bytes()).hexdigest() if "clips" in path.parts else ""
    return {str(path.relative_to(folder)): hash_of(path) for path in folder.rglob("*") if path.is_file()}


class OnSlurm(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.cluster = CLUSTER
        cls.folder = cls.cluster.folder / "data sets"
        cls.folder.mkdir()
        # Its minute runs while the other tests do: a task that waits for another writer until that is killed.
        config = {**CONFIG, "seed": 7, "clips": 8}
        cls.other_writer = cls.hold("late", config)
        cls.late = cls.submit("late", config, 1, "--", "--nodelist=n4", "--time=1", "--signal=B:USR1@55")

    @classmethod
    def submit(cls, name, config, shards, *words):
        """Numbers of the array job and of the one after it."""
        path = cls.folder / f"{name}.json"
        path.write_text(json.dumps(config))
        ran = cls.cluster.run(SCRIPTS / "submit.sh", path, cls.folder / name, "--shards", str(shards), "--mem=300M", *words)
        if ran.returncode:
            raise AssertionError(f"submit.sh: {ran}")
        return [int(number) for number in re.findall(r": +job (\d+)", ran.stdout)]

    @classmethod
    def one_process(cls, name, config):
        """Started; the set that it is to be."""
        path = cls.folder / f"{name}.json"
        path.write_text(json.dumps(config))
        return subprocess.Popen([PROGRAM, "generate", path, "--out", cls.folder / name, "--quiet"],
                                stdout=subprocess.DEVNULL)
    @classmethod
    def hold(cls, name, config):
        """A process that has begun the set, and stands still: nobody else may write there until it is killed."""
        process = cls.one_process(name, config)
        wait_for("a set that is begun", (cls.folder / name / "dataset.json").exists, 60)
        process.send_signal(signal.SIGSTOP)
        return process

    @staticmethod
    def release(writer):
        writer.kill()
        writer.wait()

    def task(self, array, index):
        return next(task for task in self.cluster.jobs(array) if task.get("ArrayTaskId") == str(index))

    def wait_for_end(self, job, seconds=120):
        """Its state."""
        def state():
            states = {task["JobState"] for task in self.cluster.jobs(job)}
            return states <= ENDED and states.pop()
        return wait_for(f"the end of job {job}", state, seconds)

    def logs(self, name, array):
        """Of each task, what it printed."""
        found = (self.folder / f"{name}.logs").glob(f"generate-{array}_*.log")
        return {int(path.stem.rpartition("_")[2]): path.read_text() for path in found}

    def finish_log(self, name, finish):
        return (self.folder / f"{name}.logs" / f"finish-{finish}.log").read_text()

    def wait_for_work(self, name, array, shards):
        """Until all of its tasks run and have clips finished."""
        def at_work():
            done = [path for path in (self.folder / name).glob("manifest.*.jsonl") if path.stat().st_size]
            return len(done) == shards and {task["JobState"] for task in self.cluster.jobs(array)} == {"RUNNING"}
        wait_for(f"{shards} tasks at work", at_work, 60)

    def assert_same_set(self, name, other):
        self.assertEqual(clips_of(self.folder / name), clips_of(self.folder / other))
        self.assertEqual(files_of(self.folder / name), files_of(self.folder / other))

    def test_an_array_survives_its_nodes(self):
        array, finish = self.submit("set", CONFIG, 8)
        self.wait_for_work("set", array, 8)
        nodes = {int(task["ArrayTaskId"]): task["NodeList"] for task in self.cluster.jobs(array)}
        # The task that has the array's own number: as if its time were up. It must requeue itself alone.
        late = next(int(task["ArrayTaskId"]) for task in self.cluster.jobs(array) if task["JobId"] == str(array))
        dead_node, requeued_node, *_ = sorted({"n1", "n2", "n3"} - {nodes[late]})  # n4 has another task
        dead = [index for index, node in nodes.items() if node == dead_node]
        requeued = next(index for index, node in nodes.items() if node == requeued_node)
        self.cluster.kill_node(dead_node)
        self.cluster.run("scontrol", "requeue", f"{array}_{requeued}", check=True)
        self.cluster.run("scancel", "--batch", "--signal=USR1", f"{array}_{late}", check=True)
        one = self.one_process("one", CONFIG)

        self.assertEqual(self.wait_for_end(finish), "COMPLETED", self.finish_log("set", finish))
        self.assertEqual(one.wait(), 0)
        self.assert_same_set("set", "one")
        self.assertNotIn("missing", self.finish_log("set", finish))
        logs = self.logs("set", array)
        for index in range(8):
            self.assertEqual(self.task(array, index)["JobState"], "COMPLETED")
            self.assertIn("exit code 0", logs[index])
        for index in dead:
            self.assertGreaterEqual(int(self.task(array, index)["Restarts"]), 1)
            self.assertRegex(logs[index], rf"(?s)on {dead_node}, restarts so far: 0.*on n., restarts so far: [1-9]")
        self.assertRegex(logs[requeued], "restarts so far: [1-9]")
        self.assertRegex(logs[late], r"(?s)time limit ends it.*restarts so far: [1-9].*exit code 0\n$")
        self.assertEqual([index for index in range(8) if "time limit" in logs[index]], [late])
        self.assertLessEqual({index for index in range(8) if "DUE TO JOB REQUEUE" in logs[index]}, {requeued, late})

    def test_the_same_command_again_recovers(self):
        config = {**CONFIG, "seed": 6, "clips": 40}
        array, finish = self.submit("again", config, 2)
        self.wait_for_work("again", array, 2)
        self.cluster.run("scancel", f"{array}_1", check=True)
        one = self.one_process("again_one", config)
        self.assertEqual(self.wait_for_end(finish), "FAILED")
        self.assertRegex(self.finish_log("again", finish), r"(?s)shard 1/2: \d+ clips missing\n.*not whole: ")
        self.assertNotIn("shard 0/2", self.finish_log("again", finish))
        self.assertRegex(self.logs("again", array)[1], r"exit code 130\n$")  # in good order
        array, finish = self.submit("again", config, 2, "--at-once", "1", "--cpus=2", "--time", "30", "--partition=main",
                                    "--finish-time=1:00:00", "--", "--comment=ours")
        for job, limit in (array, "00:30:00"), (finish, "01:00:00"):
            for shown in self.cluster.jobs(job):
                self.assertEqual([shown[key] for key in ("TimeLimit", "NumCPUs", "Partition", "Comment")],
                                 [limit, "2", "main", "ours"])
        self.assertIn("1", {shown.get("ArrayTaskThrottle") for shown in self.cluster.jobs(array)})
        self.assertEqual(self.wait_for_end(finish), "COMPLETED", self.finish_log("again", finish))
        self.assertNotIn("missing", self.finish_log("again", finish))
        self.assertEqual(one.wait(), 0)
        self.assert_same_set("again", "again_one")

    def test_the_time_limit_ends_a_task_and_it_goes_on(self):
        array, finish = self.late
        wait_for("the time limit", lambda: int(self.task(array, 0)["Restarts"]) > 0, 120)
        self.release(self.other_writer)
        self.assertEqual(self.wait_for_end(finish), "COMPLETED", self.finish_log("late", finish))
        self.assertRegex(self.logs("late", array)[0],
                         r"(?s)so far: 0\n.*exit code 130\n.*time limit ends it.*so far: [1-9].*exit code 0\n$")

    def test_a_task_is_not_started_again_for_ever(self):
        config = {**CONFIG, "clips": 1}
        other_writer = self.hold("given_up", config)
        self.cluster.environment["SHIMMER_MAX_RESTARTS"] = "0"
        array, finish = self.submit("given_up", config, 1)
        del self.cluster.environment["SHIMMER_MAX_RESTARTS"]
        wait_for("a start", lambda: "so far: 0" in self.logs("given_up", array).get(0, ""), 60)
        self.cluster.run("scancel", "--batch", "--signal=USR1", f"{array}_0", check=True)
        self.assertEqual(self.wait_for_end(array), "FAILED")
        self.assertEqual(self.task(array, 0)["Restarts"], "0")
        self.assertRegex(self.logs("given_up", array)[0], r"the time limit ended it after 0 restarts; no more of them")
        self.release(other_writer)
        self.wait_for_end(finish)

    def test_a_failed_clip_is_not_tried_for_ever(self):
        (self.folder / "pictures").mkdir()
        (self.folder / "pictures" / "bad.png").write_bytes(b"no picture")
        array, finish = self.submit("bad", {**CONFIG, "source": {"images": "pictures"}, "clips": 2}, 2)
        self.assertEqual(self.wait_for_end(finish), "FAILED")
        for index in range(2):
            task = self.task(array, index)
            self.assertEqual((task["JobState"], task["Restarts"]), ("FAILED", "0"))
        self.assertIn("0 of 2 clips done, 2 failed", self.finish_log("bad", finish))

    def test_submit_refuses_what_cannot_be(self):
        path = self.folder / "good.json"
        path.write_text(json.dumps(CONFIG))
        out = self.folder / "never"
        jobs = self.cluster.run("squeue", "--noheader").stdout.count("\n")
        for words, error in [
            ([path], "needs CONFIG, OUT and --shards N"),
            ([path, out], "needs --shards N"),
            ([path, out, "--shards"], "--shards needs a value"),
            ([path, out, "--shards", "0"], "--shards is '0', must be a whole number from 1"),
            ([path, out, "--shards", "8x"], "--shards is '8x', must be"),
            ([path, out, "--shards=41"], "--shards is 41, must be at most 40, this cluster's MaxArraySize"),
            ([path, out, "--shards", "8", "--cpus", "0"], "--cpus is '0', must be"),
            ([path, out, "--shards", "8", "--at-once=-1"], "--at-once is '-1', must be"),
            ([path, out, "--shards", "8", "--time", "soon"], "--time is 'soon', must be like"),
            ([path, out, "--shards", "8", "--time=4:59"], "--time is '4:59', must be 5 minutes or more"),
            ([path, out, "--shards", "8", "--nice"], "unknown option '--nice'; those of sbatch go after --"),
            ([path, out, "third", "--shards", "8"], "'third' is one too many"),
            ([out, out, "--shards", "8"], "shimmer: "),
            ([path, out, "--shards", "8", "--set", "tilt.strength_px=-5"], "/tilt/strength_px: is -5"),
        ]:
            with self.subTest(words=words[1:]):
                ran = self.cluster.run(SCRIPTS / "submit.sh", *words)
                self.assertEqual((ran.returncode, ran.stdout), (2, ""), ran.stderr)
                self.assertIn(error, ran.stderr)
                self.assertEqual(ran.stderr.count("\n"), 1, ran.stderr)
        self.assertEqual(list(self.folder.glob("never*")), [])
        self.assertLessEqual(self.cluster.run("squeue", "--noheader").stdout.count("\n"), jobs)


def main():
    global PROGRAM, CLUSTER
    PROGRAM = pathlib.Path(sys.argv.pop(1)).resolve()
    if missing := what_is_missing():
        print(f"skipped: {missing}")
        return SKIPPED
    for end in signal.SIGTERM, signal.SIGALRM:  # whatever ends this, the daemons go with it
        signal.signal(end, signal.default_int_handler)
    signal.alarm(SECONDS)
    with Cluster() as CLUSTER:
        CLUSTER.environment["SHIMMER"] = str(PROGRAM)
        result = unittest.main(verbosity=2, exit=False).result
        if not result.wasSuccessful():
            print(CLUSTER.log("slurmctld", lines=100))
    return 0 if result.wasSuccessful() else 1


if __name__ == "__main__":
    sys.exit(main())
