"""Rows of figures as text."""

Row = dict[str, str | float]


def layout(value: str | float) -> str:
    """Write a number with four digits, a count in full."""
    if isinstance(value, str):
        return value
    return f"{value:d}" if isinstance(value, int) else f"{value:.4g}"


def _columns(rows: list[Row]) -> list[str]:
    """Every figure that any row has; a checksum is none."""
    keys = dict.fromkeys(key for row in rows for key in row)
    return [key for key in keys if key not in {"bench", "checksum"}]


def table(rows: list[Row]) -> str:
    """Lay rows of one bench out as a table; a checksum is no figure and is left out."""
    keys = _columns(rows)
    lines = [[key.replace("_", " ") for key in keys]]
    lines += [[layout(row.get(key, "")) for key in keys] for row in rows]
    widths = [max(len(line[column]) for line in lines) for column in range(len(keys))]
    lines.insert(1, ["-" * width for width in widths])
    return "\n".join(
        "  ".join(
            cell.ljust(width) if column == 0 else cell.rjust(width)
            for column, (cell, width) in enumerate(zip(line, widths, strict=True))
        ).rstrip()
        for line in lines
    )


def markdown(rows: list[Row]) -> str:
    """Lay rows of one bench out as a Markdown table, to be pasted into a document."""
    keys = _columns(rows)
    lines = [[key.replace("_", " ") for key in keys], ["---"] + ["--:"] * (len(keys) - 1)]
    lines += [[layout(row.get(key, "")) for key in keys] for row in rows]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)
