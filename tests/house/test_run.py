"""The set-up script: its decisions, tried with stand-ins for Python so that nothing is installed."""

import os
import re
import shutil
import stat
import subprocess
import time

import pytest

from demos.cli import COMMANDS
from tests.conftest import ROOT

SHELLS = [shell for shell in ("dash", "bash", "sh") if shutil.which(shell)]
FILES = ("run", "requirements.lock", "requirements-dev.lock", "engine/clips/sources.py")

# answers as much of Python as the script asks for; says what it was called with
STAND_IN = """#!/bin/sh
case "$*" in
*version_info*) echo {version} ;;
*realpath*) echo "{bin}/python3" ;;
"-m venv"*) mkdir -p "$4/bin" && cp "{bin}/python3" "$4/bin/python" ;;
*ensurepip*) exit 0 ;;
*"pip install"*) echo "pip $*" >>"{bin}/calls"; echo "{pip_says}" >&2; exit {pip_exit} ;;
-) cat >/dev/null ;;
*demos.set_up*) shift 3; echo "set_up $*" >>"{bin}/calls" ;;
*demos.cli*) echo "cwd=$PWD path=$PYTHONPATH cache=$BRACE_CACHE"; for word in "$@"; do echo "<$word>"; done; exit 7 ;;
*) echo "unexpected: $*" >&2; exit 99 ;;
esac
"""


class Checkout:
    """A copy of what the script needs, in a folder with a blank in its name, and a PATH with stand-ins."""

    def __init__(self, folder, version="3.11", pip_exit=0, pip_says=""):
        self.root = folder / "a checkout"
        self.root.mkdir()
        for name in FILES:
            (self.root / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(ROOT / name, self.root / name)
        self.home = folder / "home"
        self.home.mkdir()
        self.bin = folder / "bin"
        self.bin.mkdir()
        for tool in (
            "sh",
            "cat",
            "cksum",
            "dirname",
            "mkdir",
            "rm",
            "ls",
            "head",
            "cp",
            "id",
            "flock",
            "touch",
            "tail",
        ):
            found = shutil.which(tool)
            if found:
                (self.bin / tool).symlink_to(found)
        if version:
            self.stand_in(version, pip_exit, pip_says)

    def stand_in(self, version="3.11", pip_exit=0, pip_says=""):
        python = self.bin / "python3"
        python.write_text(STAND_IN.format(version=version, bin=self.bin, pip_exit=pip_exit, pip_says=pip_says))
        python.chmod(python.stat().st_mode | stat.S_IXUSR)

    def run(self, *words, shell="sh", cwd=None, **environment):
        environment = {"PATH": str(self.bin), "HOME": str(self.home), **environment}
        return subprocess.run(
            [shutil.which(shell), str(self.root / "run"), *words], text=True, capture_output=True, cwd=cwd,
            env={key: value for key, value in environment.items() if value is not None},
        )  # fmt: skip

    @property
    def calls(self):
        calls = self.bin / "calls"
        return calls.read_text().splitlines() if calls.exists() else []


@pytest.fixture
def checkout(tmp_path):
    return Checkout(tmp_path)


@pytest.mark.parametrize("shell", SHELLS)
def test_every_shell_can_read_it(shell):
    for script in ["run"] if shell != "bash" else ["run", ".ci/run"]:
        done = subprocess.run([shell, "-n", str(ROOT / script)], capture_output=True, text=True)
        assert (done.returncode, done.stderr) == (0, "")


def test_both_scripts_may_be_executed():
    for script in ("run", ".ci/run"):
        assert os.access(ROOT / script, os.X_OK)


def test_help_needs_no_set_up(checkout):
    for words in ([], ["--help"]):
        done = checkout.run(*words)
        assert done.returncode == 0
        assert set(COMMANDS) <= set(re.findall(r"\w+", done.stdout))
        assert max(map(len, done.stdout.splitlines())) < 80
    assert not (checkout.root / ".venv").exists()


@pytest.mark.parametrize("shell", SHELLS)
def test_first_call_sets_up_and_passes_the_words_on(checkout, tmp_path, shell):
    done = checkout.run("react", "my scenario.toml", "--json", shell=shell, cwd=tmp_path)
    assert done.returncode == 7  # the command's own exit code
    where, *words = done.stdout.splitlines()
    assert where == f"cwd={tmp_path} path={checkout.root} cache={checkout.home}/.cache/brace"
    assert words[-3:] == ["<react>", "<my scenario.toml>", "<--json>"]
    pip, set_up = checkout.calls
    assert "--require-hashes" in pip
    assert set_up == "set_up clips kernels"


def test_later_calls_set_nothing_up_and_are_quick(checkout):
    checkout.run("react")
    (checkout.bin / "calls").unlink()
    begun = time.perf_counter()
    done = checkout.run("react")
    taken_s = time.perf_counter() - begun
    assert (done.returncode, done.stderr, checkout.calls) == (7, "", [])
    assert taken_s < 0.3


def test_a_new_lock_is_installed(checkout):
    checkout.run("react")
    with (checkout.root / "requirements.lock").open("a") as lock:
        lock.write("# another version\n")
    checkout.run("react")
    assert len([call for call in checkout.calls if call.startswith("pip")]) == 2


def test_tests_add_their_own_packages_once(checkout):
    checkout.run("react")
    checkout.run("test", "--stand-in")
    pips = [call for call in checkout.calls if call.startswith("pip")]
    assert len(pips) == 2
    assert pips[1].endswith("requirements-dev.lock")


def test_a_full_disk_is_not_called_a_missing_network(tmp_path):
    checkout = Checkout(tmp_path, pip_exit=1, pip_says="ERROR: [Errno 28] No space left on device")
    done = checkout.run("react")
    assert done.returncode == 3
    (line,) = [line for line in done.stderr.splitlines() if line.startswith("error")]
    assert line.startswith("error[disk-full]: no room for the packages of requirements.lock")


def test_an_interrupted_set_up_is_resumed(tmp_path):
    checkout = Checkout(tmp_path, pip_exit=1)
    done = checkout.run("react")
    assert done.returncode == 3
    assert done.stderr.splitlines()[-1].startswith("error[network]: ")
    checkout.stand_in(pip_exit=0)
    assert checkout.run("react").returncode == 7


@pytest.mark.parametrize("version", ["2.7", "3.10", "3.15"])
def test_a_python_out_of_bounds_is_one_line(tmp_path, version):
    done = Checkout(tmp_path, version=version).run("demo")
    assert done.returncode == 3
    expected = f"found Python {version}, expected 3.11 to 3.14 on PATH (or named by BRACE_PYTHON)"
    assert done.stderr == f"error[python]: {expected}\n"


@pytest.mark.parametrize("version", [None, "3.10"])
def test_a_python_that_only_uv_knows_will_do(tmp_path, version):
    own = Checkout(tmp_path, version=version)
    elsewhere = tmp_path / "uv's own"
    elsewhere.mkdir()
    python = elsewhere / "python3"
    python.write_text(STAND_IN.format(version="3.12", bin=elsewhere, pip_exit=0, pip_says=""))
    uv = own.bin / "uv"
    uv.write_text(f'#!/bin/sh\ncase "$*" in "python find >=3.11,<3.15") echo "{python}" ;; *) exit 1 ;; esac\n')
    for program in (python, uv):
        program.chmod(0o755)
    assert own.run("react").returncode == 7
    assert (elsewhere / "calls").read_text().startswith("pip -m pip install")


def test_no_python_is_one_line(tmp_path):
    done = Checkout(tmp_path, version=None).run("demo")
    assert done.returncode == 3
    assert done.stderr.startswith("error[python]: found no Python")
    assert done.stderr.count("\n") == 1


@pytest.mark.parametrize("home", [None, "", "/proc/nowhere"])
def test_without_a_home_the_cache_lies_in_the_checkout(checkout, home):
    done = checkout.run("react", HOME=home)
    assert done.stdout.splitlines()[0].endswith(f"cache={checkout.root}/.venv/cache")


def test_the_cache_may_be_named(checkout, tmp_path):
    assert f"cache={tmp_path}/here" in checkout.run("react", BRACE_CACHE=f"{tmp_path}/here").stdout
    assert f"cache={tmp_path}/xdg/brace" in checkout.run("react", XDG_CACHE_HOME=f"{tmp_path}/xdg").stdout


def test_another_cache_only_needs_its_clips(checkout, tmp_path):
    checkout.run("react")
    (checkout.bin / "calls").unlink()
    checkout.run("react", BRACE_CACHE=f"{tmp_path}/here")
    assert checkout.calls == ["set_up clips"]


def test_nowhere_to_write_is_one_line(tmp_path):
    checkout = Checkout(tmp_path)
    (checkout.root / ".venv").write_text("in the way")
    done = checkout.run("react")
    assert done.returncode == 3
    assert done.stderr.startswith("error[unwritable]: ")
    assert done.stderr.count("\n") == 1
