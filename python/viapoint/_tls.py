"""The files of mutual TLS."""

from __future__ import annotations

import os
from dataclasses import dataclass


@dataclass(frozen=True)
class TlsFiles:
    """What a script shows a controller beyond this machine, and asks of it; PEM files.

    Attributes
    ----------
    authority : str or path
        Who has to have signed the controller's certificate.
    certificate, key : str or path
        The script's own, signed by the authority that the controller's configuration names.
    """

    authority: str | os.PathLike[str]
    certificate: str | os.PathLike[str]
    key: str | os.PathLike[str]
