#!/usr/bin/env python3
"""The JSON Schema has the keys, names, ranges and defaults of the library's tables of settings.

usage: settings.py LIBRARY SCHEMA
"""
import ctypes
import json
import sys

KINDS = {1: "image", 2: "camera", 5: "material", 7: "render"}
FLAG, WHOLE, NUMBER, CHOICE = range(4)


class Choice(ctypes.Structure):
    _fields_ = [("name", ctypes.c_char_p), ("value", ctypes.c_int)]


class Setting(ctypes.Structure):
    """hl_setting of halflight/settings.h"""
    _fields_ = [("key", ctypes.c_char_p), ("field", ctypes.c_char_p), ("type", ctypes.c_int), ("unit", ctypes.c_char_p),
                ("low", ctypes.c_double), ("high", ctypes.c_double), ("open_low", ctypes.c_int),
                ("standard", ctypes.c_double * 3), ("choices", ctypes.POINTER(Choice)), ("offset", ctypes.c_size_t),
                ("only_for", ctypes.c_uint), ("optional", ctypes.c_int), ("sentence", ctypes.c_char_p),
                ("mend", ctypes.c_char_p), ("option", ctypes.c_char_p)]


library = ctypes.CDLL(sys.argv[1])
library.hl_setting_count.restype = ctypes.c_size_t
library.hl_setting_get.restype = ctypes.POINTER(Setting)
library.hl_setting_get.argtypes = [ctypes.c_int, ctypes.c_size_t]
schema = json.load(open(sys.argv[2]))
problems = []
checked = 0


def choices_of(setting):
    found, at = {}, 0
    while setting.choices and setting.choices[at].name:
        found[setting.choices[at].name.decode()] = setting.choices[at].value
        at += 1
    return found


def compare(place, what, in_schema, in_table):
    global checked
    checked += 1
    if in_schema != in_table:
        problems.append(f"{place}: {what} is {in_schema} in the schema, {in_table} in the table")


for kind, name in KINDS.items():
    parent = schema["$defs"]["volume"]["properties"] if name == "material" else schema["$defs"]
    properties = parent[name]["properties"]
    rows = [library.hl_setting_get(kind, s).contents for s in range(library.hl_setting_count(kind))]
    compare(name, "the list of keys", sorted(properties), sorted(row.key.decode() for row in rows))
    for row in rows:
        key = row.key.decode()
        said, place, names = properties.get(key, {}), f"{name}.{key}", choices_of(row)
        numbers = [part for part in said.get("oneOf", [said]) if part.get("type") in ("integer", "number")]
        if row.type == CHOICE:
            compare(place, "the choice", sorted(said.get("enum", [])), sorted(names))
        if row.type in (WHOLE, NUMBER) and numbers:
            low = "exclusiveMinimum" if row.open_low else "minimum"
            compare(place, low, numbers[0].get(low), row.low)
            compare(place, "maximum", numbers[0].get("maximum"), row.high)
        if "default" in said and not isinstance(said["default"], (list, bool)):
            default = names.get(said["default"]) if isinstance(said["default"], str) else said["default"]
            compare(place, "default", default, row.standard[0])
if checked < 50:
    problems.append(f"only {checked} comparisons were made")
print("\n".join(problems) or f"{checked} comparisons")
sys.exit(1 if problems else 0)
