"""`tools/figures` after the set-up: draw the figures asked for, then the page of all.

    python -m mirrorfigures [--list] [PAPER/FIGURE | PAPER]...
"""

import subprocess
import sys
import time

from . import page, paths, registry


def main(arguments: list[str]) -> int:
    known = registry.scripts()
    if arguments == ["--list"]:
        print("\n".join(script.id for script in known))
        return 0
    try:
        wanted = registry.find(arguments, known) if arguments else known
    except registry.UnknownFigure as error:
        print(error, file=sys.stderr)
        return 2
    failed = {}
    for count, script in enumerate(wanted, start=1):
        print(f"[{count}/{len(wanted)}] {script.id}", file=sys.stderr, flush=True)
        start = time.monotonic()
        error = draw(script)
        if error:
            failed[script.id] = error
        state = "failed" if error else "drawn"
        print(f"  {state} in {time.monotonic() - start:.1f} s", file=sys.stderr, flush=True)
    page.write(paths.out(), failed)
    if failed:
        print(f"{len(failed)} of {len(wanted)} failed: {', '.join(failed)}", file=sys.stderr)
    return 1 if failed else 0


def draw(script: registry.Script) -> str:
    """Run one script in its own process. Returns what it said if it failed, else nothing."""
    command = [sys.executable, str(script.path)]
    said = []
    with subprocess.Popen(command, stderr=subprocess.PIPE, text=True) as process:
        for line in process.stderr:
            sys.stderr.write(line)
            said.append(line)
    if process.returncode == 0:
        return ""
    return "".join(said[-3:]).strip() or f"exit {process.returncode}"


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
