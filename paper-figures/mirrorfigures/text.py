"""Sentences about rows."""


def accuracy_lines(row: dict) -> str:
    """The headline and the percentiles of a row, with the share they speak of."""
    accuracy = row["accuracy"]
    displaced = accuracy["displacement_px"]
    bad = f"bad at 1 px: {100 * accuracy['bad_share']['1']:.1f} % of mirror pixels"
    if displaced is None:  # nothing is shown where it could be
        return bad
    return (
        f"{bad}\ndisplaced {displaced['median']:.1f} px median, {displaced['p95']:.1f} px p95 "
        f"(of {100 * accuracy['covered']:.0f} %)"
    )


def ratio(row: dict) -> str:
    """What a row's frame costs beside the first of its table, its interval, and what they say."""
    if not row["ratio"]:
        return ""
    frame = row["ratio"]["frame"]
    low, high = frame["ci95"]
    said = frame["verdict"].replace("-", " ")
    return f"{frame['median']:.2f} ({low:.2f}–{high:.2f}), {said}"


def verdict(row: dict) -> str:
    """One row's accuracy in words."""
    accuracy = row["accuracy"]
    displaced = accuracy["displacement_px"]
    width, height = row["size"]
    sentences = (
        f"At {width} x {height}, {100 * accuracy['bad_share']['1']:.1f} % of the mirror's pixels show "
        f"something else than the truth does or show it more than a pixel away; "
        f"{100 * accuracy['wrong_object']:.1f} % are of the wrong object."
    )
    if displaced is None:
        return sentences
    return (
        f"{sentences} What is shown is displaced by {displaced['median']:.1f} px in the median, "
        f"{displaced['p95']:.1f} px at the 95th percentile and {displaced['max']:.1f} px at most."
    )


def steadiness_line(row: dict) -> str:
    """One row's stability in words."""
    stability = row["stability"]
    first, last = stability["frames"]
    jitter = stability["jitter_px"]
    trembling = "shows no point over three frames"
    if jitter:
        trembling = f"trembles by {jitter['median']:.3f} px in the median and {jitter['p95']:.3f} px at p95"
    return (
        f"{row['case']} {trembling}, and pops in {stability['pops']} of the frames {first} to {last}; "
        f"{100 * stability['covered']:.0f} % of the points are found, which move at up to "
        f"{stability['speed_px']:.2f} px a frame."
    )
