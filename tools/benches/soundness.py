"""Every motion of a run against its limits, whatever it was measured for."""

from benches.tables import Row

MOST_SHARE = 1.0 + 1e-6
"""The share of a limit up to which it counts as kept."""


def worst_shares(figures: list[Row]) -> list[Row]:
    """Return a row for each bench whose motions carry a proof: the worst share of any limit."""
    shares: dict[str, list[float]] = {}
    for row in figures:
        if "worst_share" in row:
            shares.setdefault(str(row["bench"]), []).append(float(row["worst_share"]))
    return [
        {
            "bench": "worst share",
            "case": bench,
            "cases": len(found),
            "worst_share": max(found),
            "above_1": max(0.0, max(found) - 1.0),
        }
        for bench, found in shares.items()
    ]


def broken(rows: list[Row]) -> bool:
    """Tell whether any limit was exceeded."""
    return any(float(row["worst_share"]) > MOST_SHARE for row in rows)
