"""The command line as a user meets it: help, one-line errors, exit codes."""

import subprocess
import sys

import pytest

from demos import cli
from demos.cli import COMMANDS, main
from engine.core.errors import BadInput, EnvironmentTrouble, ReplayDiverged
from tests.conftest import ROOT

HEAVY = ("numpy", "numba", "scipy", "pydantic", "moderngl", "mujoco", "PIL", "matplotlib", "tomllib")


@pytest.fixture
def broken_command(monkeypatch):
    """Makes `brace doctor` do whatever the test wants."""
    import demos.commands.doctor as doctor

    def breaks(run):
        monkeypatch.setattr(doctor, "run", run)

    return breaks


def raiser(trouble):
    def run(args):
        raise trouble

    return run


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_has_help_with_an_example(command, capsys):
    with pytest.raises(SystemExit) as end:
        main([command, "--help"])
    assert end.value.code == 0
    assert f"example: brace {command}" in capsys.readouterr().out


def test_help_imports_nothing_heavy():
    """The reason why it answers in a blink."""
    words = "import sys; sys.argv = ['brace', '--help']\ntry:\n import demos.cli; demos.cli.main()\nfinally:\n"
    words += f" print('HEAVY', sorted(set(sys.modules) & set({HEAVY!r})))"
    done = subprocess.run([sys.executable, "-c", words], cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0
    assert "HEAVY []" in done.stdout
    for command in COMMANDS:
        assert command in done.stdout


def test_an_unknown_command_names_its_neighbours(capsys):
    assert main(["docter"]) == 2
    line = capsys.readouterr().err
    assert line.startswith("error[usage]: unknown command 'docter'; expected one of doctor, ")
    assert line.count("\n") == 1


@pytest.mark.parametrize("words", [[], ["doctor", "--jsn"], ["bench", "--json=3"]])
def test_wrong_words_are_one_line(words, capsys):
    assert main(words) == 2
    err = capsys.readouterr().err
    assert err.startswith("error[usage]: ")
    assert "--help" in err
    assert err.count("\n") == 1


NONSENSE = {
    "capture sway -o x.png --frames -3": "--frames: found '-3', expected a whole number from 1",
    "capture sway -o x.png --columns 0": "--columns: found '0', expected a whole number from 1",
    "capture sway -o x.mp4 --from -1": "--from: found '-1', expected seconds, 0 or more",
    "capture sway -o x.mp4 --to nan": "--to: found 'nan', expected seconds, 0 or more",
    "capture sway -o x.mp4 --from 9": "nothing lies from 9 to 3.5 s; the scenario lasts 3.5 s",
    "capture sway -o x.mp4 --from 2 --to 1": "nothing lies from 2 to 1 s",
    "capture sway -o x.mp4 --tracks x.txt": "--tracks x.txt: expected a name that ends in .npz",
    "pose --clip sway --at nan": "--at: found 'nan', expected seconds, 0 or more",
    "pose --clip sway --azimuth 1e300": "less than or equal to 360",
    "bench --motion --seed -1": "--seed: found '-1', expected a whole number from 0",
    "bench --motion --render": "expected one of them at a time",
    "bench search --out x": "--out goes with --motion",
    "demo sway --quality good2": "--quality 'good2': expected auto, best",
}


@pytest.mark.parametrize("line", NONSENSE)
def test_words_that_make_no_sense_are_refused_before_any_work(line, capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert main(line.split()) == 2
    err = capsys.readouterr().err
    assert NONSENSE[line] in err
    assert err.count("\n") == 1
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("trouble", "code", "line"),
    [
        (BadInput("bvh", "93 numbers,\nfound 92", "a.bvh:17"), 2, "error[bvh] a.bvh:17: 93 numbers, found 92\n"),
        (EnvironmentTrouble("disk-full", "no room"), 3, "error[disk-full]: no room\n"),
        (ReplayDiverged("diverged", "at tick 4"), 4, "error[diverged]: at tick 4\n"),
        (KeyboardInterrupt(), 130, ""),
    ],
)  # fmt: skip
def test_every_failure_has_its_line_and_its_code(broken_command, capsys, trouble, code, line):
    broken_command(raiser(trouble))
    assert main(["doctor"]) == code
    assert capsys.readouterr().err == line


def test_a_fault_of_ours_is_one_line_too(broken_command, capsys, monkeypatch):
    broken_command(raiser(RuntimeError("shape\nmismatch")))
    assert main(["doctor"]) == cli.EXIT_INTERNAL
    err = capsys.readouterr().err
    assert err.startswith("error[internal]: RuntimeError: shape mismatch; please report this")
    assert err.count("\n") == 1
    monkeypatch.setenv("BRACE_DEBUG", "1")
    assert main(["doctor"]) == cli.EXIT_INTERNAL
    assert "Traceback" in capsys.readouterr().err


def test_a_reader_that_goes_away_is_no_error():
    words = f'(sleep 0.3; exec "{sys.executable}" -m demos.cli --help) | true; echo ${{PIPESTATUS[0]}}'
    done = subprocess.run(["bash", "-c", words], cwd=ROOT, capture_output=True, text=True)
    assert done.stderr == ""
    assert done.stdout.strip() in ("0", "141")  # whether the pipe broke before the text was out is the kernel's choice


def test_an_unwritable_locale_does_not_break_words():
    words = "from demos.cli import main; import demos.commands.doctor as d; d.run = lambda a: print('9 \\xb0')"
    done = subprocess.run(
        [sys.executable, "-c", f"{words}; raise SystemExit(main(['doctor']))"], cwd=ROOT, capture_output=True,
        text=True, env={"PYTHONIOENCODING": "ascii", "PATH": ""},
    )  # fmt: skip
    assert (done.returncode, done.stdout, done.stderr) == (0, "9 \\xb0\n", "")


def test_an_unknown_benchmark_names_its_neighbours(capsys):
    assert main(["bench", "kinematic"]) == 2
    assert "expected one of kinematics, " in capsys.readouterr().err


@pytest.mark.parametrize("closed", [">&-", ">&- 2>&-"])
def test_streams_that_were_closed_are_no_trouble(closed):
    """As a scheduler may start a program."""
    words = f'"{sys.executable}" -m demos.cli clips list {closed}'
    assert subprocess.run(["sh", "-c", words], cwd=ROOT, check=False).returncode == 0
