"""What a verification finds: what is wrong, by its place, and what was proven."""

from __future__ import annotations

from dataclasses import dataclass, field


@dataclass(frozen=True)
class Finding:
    """Something that is wrong.

    Attributes
    ----------
    what : str
        One sentence.
    piece, move, joint : int or None
        From 0.
    time : float or None
        [s]
    value, limit : float or None
        [SI, rad]
    """

    what: str
    piece: int | None = None
    move: int | None = None
    time: float | None = None
    joint: int | None = None
    value: float | None = None
    limit: float | None = None

    def __str__(self) -> str:
        """Say all of it in one line."""
        parts = []
        for name, number in (("piece", self.piece), ("move", self.move)):
            if number is not None:
                parts.append(f"{name} {number}")
        if self.joint is not None:
            parts.append(f"joint {self.joint + 1}")
        if self.time is not None:
            parts.append(f"{self.time:.6f} s")
        place = f" ({', '.join(parts)})" if parts else ""
        numbers = ""
        if self.value is not None and self.limit is not None:
            numbers = f": {self.value:.12g}, allowed {self.limit:.12g}"
        return self.what + place + numbers


@dataclass(frozen=True)
class Proof:
    """One line of what was proven: the worst of a quantity, and what is allowed."""

    quantity: str
    worst: str
    allowed: str
    holds: bool


@dataclass
class Verdict:
    """All of it. The motion is as its file says where there are no findings."""

    name: str
    robot: str
    pieces: int
    duration: float
    findings: list[Finding] = field(default_factory=list)
    proofs: list[Proof] = field(default_factory=list)

    @property
    def holds(self) -> bool:
        """True when nothing was found."""
        return not self.findings

    def prove(self, quantity: str, worst: str, allowed: str, before: int) -> None:
        """Note a line; it holds where no finding was added since there were `before`."""
        self.proofs.append(Proof(quantity, worst, allowed, len(self.findings) == before))
