#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Fails when a layer includes a header of a layer it does not name, or names one that is not below it, or when two headers
define a type of the same name: all live in namespace ramify, and the linker would mix them up without a word.

check_layers.py ROOT: reads src/README.md (the table), src/ramify/*/CMakeLists.txt (USES) and every #include.
"""
import pathlib
import re
import sys

ROW = re.compile(r"^\| L(\d) \| (\w+) \| ([^|]*) \|", re.M)
INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^">]+)[">]', re.M)
# Headers of outside libraries that must not leak into public headers.
TYPE = re.compile(r"^(?:struct|class|enum class) (\w+)[^;]*?\{", re.M)
PRIVATE = re.compile(r"^(opencv2/|vips/|Imf|OpenEXR/|fftw3|maxflow|svm\.h|nlohmann/|CLI/|pugixml)")


def main(root):
    faults = []
    types = {}
    table = {}
    for level, layer, uses in ROW.findall((root / "src/README.md").read_text()):
        table[layer] = (int(level), uses.split())
    folders = sorted(p.name for p in (root / "src/ramify").iterdir() if (p / "CMakeLists.txt").exists())
    if folders != sorted(table):
        faults.append(f"src/README.md lists {sorted(table)}, the folders are {folders}")
    for layer in folders:
        level, uses = table.get(layer, (99, []))
        allowed = set(table) - {layer} if uses[:1] == ["all"] else set(u for u in uses if u != "–")
        for lower in allowed:
            if lower in table and table[lower][0] >= level:
                faults.append(f"{layer} (L{level}) may not use {lower} (L{table[lower][0]})")
        cmake = (root / "src/ramify" / layer / "CMakeLists.txt").read_text()
        named = re.search(r"USES ([\w \n]*?)(?:PUBLIC|PRIVATE|\))", cmake)
        for lower in (named.group(1).split() if named else []):
            if lower not in allowed:
                faults.append(f"src/ramify/{layer}/CMakeLists.txt: USES {lower}, which src/README.md does not allow")
        for path in sorted((root / "src/ramify" / layer).rglob("*")):
            if path.suffix not in (".h", ".cpp"):
                continue
            text = path.read_text()
            if "SPDX-License-Identifier: GPL-3.0-or-later" not in text[:200]:
                faults.append(f"{path.relative_to(root)}: no SPDX line")
            for name in set(TYPE.findall(text)) if path.suffix == ".h" else []:
                types.setdefault(name, []).append(str(path.relative_to(root)))
            for header in INCLUDE.findall(text):
                if header.startswith("ramify/"):
                    lower = header.split("/")[1]
                    if lower != layer and lower not in allowed:
                        faults.append(f"{path.relative_to(root)}: includes {header}")
                elif path.suffix == ".h" and path.name not in ("cv_view.h", "vips_library.h") and PRIVATE.match(header):
                    faults.append(f"{path.relative_to(root)}: a public header includes {header}")
    faults += [f"{name} is defined in {' and in '.join(files)}" for name, files in sorted(types.items()) if len(files) > 1]
    for fault in faults:
        print(fault)
    print(f"{len(folders)} layers, {len(faults)} faults")
    return 1 if faults or not folders else 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1])))
