#!/usr/bin/env python3
"""Makes the C source of halflight._native: the public headers, declared to cffi as the compiler reads them.

usage: make_declarations.py INCLUDE NATIVE_H NATIVE_C OUTPUT -- COMPILER ...
"""
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import cffi

PYTHON_FUNCTIONS = """
extern "Python" int python_wants_stop(void);
extern "Python" int python_progress(const char *stage, double fraction);
extern "Python" void python_log(int level, const char *message);
extern "Python" void python_array_released(uintptr_t key);
extern "Python" hl_status python_convert(const char *path, const void **bytes, size_t *byte_count, hl_error *error);
extern "Python" void python_converted(const void *bytes);
"""


def declarations(include: Path, native: Path, compiler: list[str]) -> str:
    """The headers without comments, macros, attributes, or what they include of the system's."""
    with tempfile.TemporaryDirectory() as empty:
        for name in ("stddef.h", "stdint.h"):
            (Path(empty) / name).write_text("")
        whole = f"#include <halflight/halflight.h>\n{native.read_text()}"
        # A compiler without extensions is given none: HL_API and HL_WARN_UNUSED are empty.
        flags = ["-E", "-P", "-nostdinc", "-U__GNUC__", "-U__clang__", f"-I{empty}", f"-I{include}", "-x", "c", "-"]
        text = subprocess.run([*compiler, *flags], input=whole, capture_output=True, text=True, check=True).stdout
    # cffi before 1.16 misplaces the const of pointers to arrays.
    return text if cffi.__version_info__ >= (1, 16) else re.sub(r"\bconst (\w+ \(\*)", r"\1", text)


def main() -> None:
    include, native_h, native_c, output = map(Path, sys.argv[1:5])
    compiler = sys.argv[sys.argv.index("--") + 1:]
    builder = cffi.FFI()
    builder.cdef(declarations(include, native_h, compiler) + PYTHON_FUNCTIONS)
    builder.set_source("halflight._native", native_c.read_text().replace('#include "native.h"', native_h.read_text()),
                       py_limited_api=True)
    builder.emit_c_code(str(output))
    # Python's headers for the stable ABI leave these out, and code by older versions of cffi needs them.
    output.write_text("#include <alloca.h>\n#include <string.h>\n" + output.read_text())


main()
