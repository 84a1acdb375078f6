"""The stand-in's rows are rows: what the figures are tested on is what the binary prints."""

import json

import jsonschema

from mirrorfigures import bench, paths, render


def test_the_stand_in_prints_rows_of_the_schema(fake):
    schema = json.loads((paths.FIGURES / "results.schema.json").read_text(encoding="utf-8"))
    rows = bench("columns", ["none", "environment-map"], size="64x64", frames="0..1", repeat=5).rows
    rows += render("columns", "truth").rows
    for row in rows:
        jsonschema.validate(row, schema)
