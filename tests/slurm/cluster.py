"""A Slurm of four nodes on this machine: its own daemons, key, ports and folder, all gone afterwards."""

import ctypes
import os
import pathlib
import random
import shutil
import signal
import socket
import subprocess
import tempfile
import time

NODES = ["n1", "n2", "n3", "n4"]

LIBC = ctypes.CDLL(None, use_errno=True)
PR_SET_PDEATHSIG, PR_SET_CHILD_SUBREAPER, CLONE_NEWUTS = 1, 36, 0x04000000

# cred_expire is how long a requeued job waits (5 s is the least), SlurmdTimeout how long a node may be dead unnoticed.
# Nodes say that they have three processors, whatever the machine has (config_overrides).
CONFIGURATION = """\
ClusterName=shimmertest
SlurmctldHost={host}({address})
SlurmctldPort={ports[0]}
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
CryptoType=crypto/munge
AuthInfo=socket={folder}/munge.socket,cred_expire=5
CommunicationParameters=NoCtldInAddrAny,NoInAddrAny
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/%n
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/%n.pid
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core_Memory,CR_LLN
SchedulerParameters=sched_interval=1,sched_min_interval=50000,batch_sched_delay=1,bf_interval=1
SlurmdParameters=config_overrides
ReturnToService=2
SlurmdTimeout=10
KillWait=10
MaxArraySize=40
PartitionName=main Nodes=ALL Default=YES MaxTime=INFINITE State=UP
"""
NODE = "NodeName={name} NodeHostname={host} NodeAddr={address} Port={port} CPUs=3 RealMemory=2000 State=UNKNOWN\n"


def what_is_missing():
    """Why no cluster can be started here, or None."""
    if os.geteuid() != 0:
        return "needs root: the daemons run jobs as their users"
    if absent := [name for name in ("munged", "slurmctld", "slurmd", "sbatch") if not shutil.which(name)]:
        return f"needs {', '.join(absent)} (scripts/setup.sh --all)"
    try:
        name_and_address()
    except OSError:
        return f"needs an address for this machine's name, {socket.gethostname()} (in /etc/hosts)"
    return None


def name_and_address():
    """Of this machine. Slurm's daemons listen at the address that its name has: where this process may give it a name
    for itself, that is loopback's; else what the name resolves to, often loopback too."""
    if LIBC.unshare(CLONE_NEWUTS) == 0:
        socket.sethostname("localhost")
    name = socket.gethostname().partition(".")[0]
    return name, socket.gethostbyname(name)


def free_ports(address, count):
    """Below those that the system itself gives to outgoing connections."""
    ports = []
    while len(ports) < count:
        port = random.SystemRandom().randrange(15000, 32000)
        with socket.socket() as probe:
            try:
                probe.bind((address, port))
            except OSError:
                continue
        if port not in ports:
            ports.append(port)
    return ports


def wait_for(what, condition, seconds):
    """Until condition() is true, which is returned."""
    deadline = time.monotonic() + seconds
    while not (value := condition()):
        if time.monotonic() > deadline:
            raise TimeoutError(f"waited {seconds} s for {what}")
        time.sleep(0.1)
    return value


def descendants(pid):
    """Of a process: its children, theirs, and so on."""
    children = {}
    for status in pathlib.Path("/proc").glob("[0-9]*/stat"):
        try:
            parent = int(status.read_text().rpartition(")")[2].split()[1])
        except (FileNotFoundError, ProcessLookupError):
            continue
        children.setdefault(parent, []).append(int(status.parent.name))
    found = list(children.get(pid, []))
    for child in found:  # grows while it is read
        found += children.get(child, [])
    return found


def command_line(pid):
    try:
        return pathlib.Path(f"/proc/{pid}/cmdline").read_text(errors="replace")
    except (FileNotFoundError, ProcessLookupError):
        return ""


def kill(pids):
    for pid in pids:
        try:
            os.kill(pid, signal.SIGKILL)
        except ProcessLookupError:
            pass


def prctl(option, value):
    if LIBC.prctl(option, value, 0, 0, 0):
        raise OSError(ctypes.get_errno(), "prctl")


class Cluster:
    """In a `with`. Everything that this process started is killed at its end, by its pid."""

    def __init__(self):
        # What the daemons start loses its parent when they die, and then becomes a child of this process.
        prctl(PR_SET_CHILD_SUBREAPER, 1)
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="shimmer-slurm-"))
        self.folder.chmod(0o755)  # munged wants to know its socket safe
        self.daemons = {}
        self.environment = {name: value for name, value in os.environ.items()
                            if not name.startswith(("SLURM_", "SBATCH_", "SHIMMER"))}
        self.environment["SLURM_CONF"] = str(self.folder / "slurm.conf")

    def __enter__(self):
        try:
            self.start()
        except BaseException:
            self.stop()
            raise
        return self

    def __exit__(self, *_):
        self.stop()

    def start(self):
        host, address = name_and_address()
        ports = free_ports(address, 1 + len(NODES))
        text = CONFIGURATION.format(host=host, address=address, ports=ports, folder=self.folder)
        for name, port in zip(NODES, ports[1:]):
            (self.folder / name).mkdir()
            text += NODE.format(name=name, host=host, address=address, port=port)
        configuration, key = self.folder / "slurm.conf", self.folder / "munge.key"
        configuration.write_text(text)
        (self.folder / "state").mkdir()
        key.write_bytes(os.urandom(1024))
        key.chmod(0o600)
        self.start_daemon("munged", "munged", "--foreground", "--force", f"--key-file={key}",
                          f"--socket={self.folder}/munge.socket", f"--pid-file={self.folder}/munged.pid",
                          f"--seed-file={self.folder}/munge.seed")
        wait_for("munged", (self.folder / "munge.socket").exists, 10)
        self.start_daemon("slurmctld", "slurmctld", "-D", "-f", configuration)
        for name in NODES:
            self.start_daemon(name, "slurmd", "-D", "-f", configuration, "-N", name)
        wait_for("four idle nodes", lambda: self.node_states().count("idle") == len(NODES), 60)

    def start_daemon(self, name, *words):
        with open(self.folder / f"{name}.log", "w") as log:
            self.daemons[name] = subprocess.Popen(
                words, env=self.environment, stdin=subprocess.DEVNULL, stdout=log, stderr=log,
                preexec_fn=lambda: prctl(PR_SET_PDEATHSIG, signal.SIGKILL))

    def stop(self):
        while left := descendants(os.getpid()):
            kill(left)
            for daemon in self.daemons.values():
                daemon.wait()
            for pid in left:
                try:
                    os.waitpid(pid, 0)
                except ChildProcessError:  # it was waited for, or is still a child of another
                    pass
        shutil.rmtree(self.folder)

    def run(self, *words, **options):
        """A command of Slurm's users."""
        return subprocess.run(words, env=self.environment, text=True, capture_output=True, timeout=60, **options)

    def node_states(self):
        return self.run("sinfo", "--noheader", "--Node", "--format=%t").stdout.split()

    def jobs(self, job):
        """Of an array: what Slurm says of each task."""
        shown = self.run("scontrol", "--oneliner", "show", "job", str(job)).stdout
        return [dict(word.partition("=")[::2] for word in line.split()) for line in shown.splitlines() if line]

    def kill_node(self, name):
        """As when its power fails: its daemon, the daemons of its steps, and what runs in them."""
        daemon = self.daemons.pop(name)
        killed = [daemon.pid]
        for step in descendants(os.getpid()):
            tree = [step, *descendants(step)]
            if command_line(step).startswith("slurmstepd") and any(f"/{name}/job" in command_line(p) for p in tree):
                killed += tree
        kill(killed)
        daemon.wait()

    def log(self, name, lines=30):
        return "".join(open(self.folder / f"{name}.log").readlines()[-lines:])
