"""What figures were measured on."""

import os
import platform
import subprocess
from importlib import metadata
from pathlib import Path

ROOT = Path(__file__).parents[2]


def output_of(*command: str) -> str:
    """Return the first line a command prints, or "unknown" where it is not there."""
    try:
        text = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True).stdout
    except (OSError, subprocess.CalledProcessError):
        return "unknown"
    return text.partition("\n")[0].strip()


def machine() -> dict[str, str]:
    """Describe what the figures were measured on, and of what."""
    cpu = "unknown"
    for line in Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
        if line.startswith("model name"):
            cpu = line.partition(":")[2].strip()
            break
    changed = output_of("git", "status", "--porcelain", "--untracked-files=no") != ""
    commit = output_of("git", "rev-parse", "--short", "HEAD")
    return {
        "viapoint": f"{metadata.version('viapoint')}, commit {commit}"
        + (" and local changes" if changed else ""),
        "processor": f"{cpu}, {os.cpu_count()} cores",
        "system": f"{platform.system()} {platform.release()}, load {os.getloadavg()[0]:.1f}",
        "compiler": output_of("g++", "--version"),
        "python": f"{platform.python_version()}, numpy {metadata.version('numpy')}",
    }
