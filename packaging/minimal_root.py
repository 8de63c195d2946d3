"""A minimal Debian in a folder of its own, made by mmdebstrap with the apt sources of this machine. Needs root."""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time

# Folders that change without any package.
CHANGING = ("proc/", "dev/", "tmp/", "run/", "packages/", "context/", "root/", "var/log/", "var/cache/", "var/lib/apt/",
            "var/lib/dpkg/")

# Processes and mounts of their own, which end with the first of them.
ALONE = ["unshare", "--mount", "--pid", "--fork", "--kill-child", "sh", "-euc"]
# The folder is made a mount point, so that a process that makes another root there can enter it from within.
ENTER = 'mount --rbind "$0" "$0"; mount -t proc proc "$0/proc"; exec chroot "$0" "$@"'


def fail(text):
    print(f"{pathlib.Path(sys.argv[0]).name}: {text}", file=sys.stderr)
    sys.exit(1)


def require_root():
    if os.geteuid() != 0:
        fail("a separate root directory is entered by chroot, which only root can do: run this as root (sudo)")


def codename():
    text = pathlib.Path("/etc/os-release").read_text(encoding="utf-8")
    return dict(line.split("=", 1) for line in text.splitlines() if "=" in line)["VERSION_CODENAME"].strip('"')


def apt_sources():
    """The files that say from where this machine takes its packages."""
    etc = pathlib.Path("/etc/apt")
    parts = sorted((etc / "sources.list.d").glob("*.sources")) + sorted((etc / "sources.list.d").glob("*.list"))
    found = [path for path in [etc / "sources.list", *parts] if path.is_file()]
    debian = [path for path in found if "bookworm" in path.read_text(encoding="utf-8")]
    if not debian:
        fail("no file in /etc/apt names a source of Debian 12's packages (bookworm)")
    return debian


def apt_options():
    """How this machine fetches packages: proxies and the like."""
    dump = subprocess.run(["apt-config", "dump"], text=True, capture_output=True, check=True).stdout
    lines = [line for line in dump.splitlines() if line.startswith("Acquire::")]
    return "".join(f"{line}\n" for line in lines if not line.startswith(("Acquire::IndexTargets", "Acquire::Changelogs")))


class Steps:
    """Prints each step with its time, and all of it."""

    def __init__(self):
        self.begin = time.monotonic()

    def __call__(self, text, action):
        before = time.monotonic()
        said = action()
        print(f"{time.monotonic() - before:7.1f} s  {text}" + (f": {said}" if isinstance(said, str) and said else ""), flush=True)
        return said

    def end(self):
        print(f"{time.monotonic() - self.begin:7.1f} s  in all", flush=True)


class MinimalRoot:
    """`with MinimalRoot() as root: root.run("ls /")`. Commands see processes and mounts of their own, which end with them;
    the folder is removed at the end."""

    def __enter__(self):
        require_root()
        if codename() != "bookworm":
            fail("packages are made for Debian 12, and this is a different system")
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="ricochet-root-"))
        self.path = self.folder / "root"
        try:
            options = self.folder / "apt.conf"
            options.write_text(apt_options(), encoding="utf-8")
            made = subprocess.run(["mmdebstrap", "--mode=root", "--variant=minbase", f"--aptopt={options}", "bookworm",
                                   str(self.path), *map(str, apt_sources())], text=True, capture_output=True)
            if made.returncode != 0:
                fail(f"mmdebstrap failed:\n{made.stderr}")
            shutil.copy("/etc/resolv.conf", self.path / "etc" / "resolv.conf")
            self.run("apt-get update -qq")
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_):
        shutil.rmtree(self.folder)

    def attempt(self, command, directory="/", environment=None, shell=("sh", "-euc")):
        """Runs a command of the shell; the finished process, whose `stdout` has all that was said. Whatever it has started
        or mounted ends with it, or with this program. /proc is there: programs look up where they are."""
        variables = {"PATH": "/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin", "HOME": "/root", "LC_ALL": "C.UTF-8",
                     "DEBIAN_FRONTEND": "noninteractive", "TERM": "dumb", **(environment or {})}
        return subprocess.run([*ALONE, ENTER, self.path, *shell, f"cd {directory}\n{command}"], env=variables, text=True,
                              errors="replace", stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)

    def run(self, command, directory="/", environment=None, shell=("sh", "-euc")):
        """Runs a command of the shell; what it said. Ends the program with all that was said where it fails."""
        process = self.attempt(command, directory, environment, shell)
        if process.returncode != 0:
            raise SystemExit(f"{command}\nended with status {process.returncode}:\n{process.stdout}")
        return process.stdout

    def install(self, *packages, recommends=False):
        option = "" if recommends else "--no-install-recommends "
        self.run(f"apt-get install -y -qq {option}{' '.join(packages)}")

    def files(self):
        """All files and folders but those that change anyway."""
        found = set()
        for folder, names, others in os.walk(self.path):
            for name in names + others:
                path = os.path.relpath(os.path.join(folder, name), self.path)
                if not f"{path}/".startswith(CHANGING):
                    found.add(path)
            names[:] = [name for name in names
                        if not f"{os.path.relpath(os.path.join(folder, name), self.path)}/".startswith(CHANGING)]
        return found
