#!/usr/bin/env python3
"""The published JSON Schema and the scene reader agree on every case of tests/scenes/cases.json.

A case may say "schema": true where a schema cannot know what the reader refuses: files that are not there,
points out of order, directions without length. Usage: schema.py SOURCE_ROOT
"""
import json
import pathlib
import sys

try:
    import jsonschema
except ImportError:
    print("skipped: python3-jsonschema is not installed")
    sys.exit(77)


def main(root):
    schema = json.loads((root / "share/halflight.schema.json").read_text())
    jsonschema.Draft202012Validator.check_schema(schema)
    validator = jsonschema.Draft202012Validator(schema)
    cases = json.loads((root / "tests/scenes/cases.json").read_text())
    wrong = 0
    for case in cases:
        faults = list(validator.iter_errors(case["scene"]))
        expected = case.get("schema", case["accepted"])
        if (not faults) != expected:
            wrong += 1
            print(f"{case['name']}: the schema {'refuses' if faults else 'accepts'} it: {[f.message for f in faults]}")
    examples = sorted((root / "examples").glob("*.json"))
    for path in examples:
        for fault in validator.iter_errors(json.loads(path.read_text())):
            wrong += 1
            print(f"{path.name}: {fault.json_path}: {fault.message}")
    print(f"{len(cases)} cases and {len(examples)} examples, {wrong} disagreements")
    return 1 if wrong or len(cases) < 100 else 0


sys.exit(main(pathlib.Path(sys.argv[1])))
