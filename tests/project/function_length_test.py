# No function of the program is longer than 80 lines. function_length_test.py SOURCE
import re
import sys
from pathlib import Path

LONGEST = 80
TABLES = {  # each is one table, which is read from top to bottom
    "make_lookups": "a row for each lookup",
    "map_rows": "a row for each setting of map",
    "view_rows": "a row for each setting of view and scene",
    "cascade_rows": "a row for each setting of cascades",
}
REASONS = {  # too long, and why they are left for now
    "measure_ladder": "it is split with the sums of maps",
    "lookup_maps": "it is split with the drawing of maps",
    "moments_of": "it is split with the drawing of maps",
}
FOLDERS = ("app", "base", "captures", "compare", "frames", "gl", "measure", "raytrace", "scenes", "technique")
NOT_CODE = re.compile(r'^#[^\n]*|//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|(?<!\w)\'(?:\\.|[^\'\\\n])+\'', re.S | re.M)
# What stands before the bracket of a function's body, from the end of the statement before it.
HEAD = re.compile(r"(~?\w+)\s*\([^;{}]*\)[^;{}()=]*(?::[^;]*)?\{$", re.S)


def functions(path):
    """Name, first line and length of what has a body that begins in the line of its head."""
    text = NOT_CODE.sub(lambda found: ("" if found[0][0] in "/#" else '""') + "\n" * found[0].count("\n"), path.read_text())
    lines = text.split("\n")
    opened = []  # for each bracket that is open: (its line, the name of its function or None)
    statement, began = "", 0
    for number, line in enumerate(lines):
        for sign in line + "\n":
            if not statement.strip():
                began = number
            if sign == "{":
                head = HEAD.search(statement.strip() + "{")
                inside = any(name for _, name in opened)
                opened.append((began, head[1] if head and not inside and head[1] not in ("if", "for", "while", "switch", "catch") else None))
            elif sign == "}" and opened:
                first, name = opened.pop()
                if name:
                    yield name, first + 1, number - first + 1
            statement = "" if sign in ";{}" else statement + sign


def main():
    source = Path(sys.argv[1])
    files = [path for folder in FOLDERS for path in sorted((source / folder).rglob("*")) if path.suffix in (".cpp", ".h")]
    counted, long = 0, []
    for file in files:
        for name, line, length in functions(file):
            counted += 1
            if length > LONGEST and name not in TABLES and name not in REASONS:
                long.append(f"{file.relative_to(source)}:{line}: {name} has {length} lines; split it into named steps of at most {LONGEST}")
    if counted < 3000:
        long.append(f"only {counted} functions were found")
    sys.exit("\n".join(long) or 0)


main()
