"""Charts of rows and frames made by hand."""

import matplotlib.pyplot as plt

from mirrorfigures.charts import POP_SHARE, steadiness
from mirrorfigures.text import steadiness_line


def frame(number, median, popping):
    jitter = None if median is None else {"median": median, "p95": 3 * median}
    return {"frame": number, "jitter_px": jitter, "popping": popping}


def test_jitter_and_popping_are_drawn_where_they_are_known():
    frames = [frame(4, None, 0.0), frame(5, 0.1, 0.02), frame(6, 0.2, 0.0), frame(7, None, 0.01)]
    plot = steadiness({"a": frames, "b": [frame(n, 0.3, 0.0) for n in range(4, 8)]})
    jitter, popping = plot.axes
    first, second = jitter.lines
    assert list(first.get_xdata()) == [5, 6] and list(first.get_ydata()) == [0.1, 0.2]
    assert first.get_color() != second.get_color()
    share = popping.lines[0]
    assert list(share.get_xdata()) == [5, 6, 7] and list(share.get_ydata()) == [2.0, 0.0, 1.0]
    assert popping.lines[-1].get_ydata()[0] == 100 * POP_SHARE
    plt.close(plot)


def test_steadiness_in_words():
    stability = {"frames": [0, 9], "jitter_px": None, "pops": 2, "covered": 0.0, "speed_px": 1.5}
    row = {"case": "none", "stability": stability}
    assert "none shows no point over three frames, and pops in 2" in steadiness_line(row)
    stability["jitter_px"] = {"median": 0.0123, "p95": 0.5}
    assert "0.012 px in the median and 0.500 px at p95" in steadiness_line(row)
