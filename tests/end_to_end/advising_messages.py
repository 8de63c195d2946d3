"""The messages in the sources that advise a setting: C++ literals with a clause that begins with a verb such as
"set"."""

import re

from harness import SOURCE

TOKEN = re.compile(r'R"(?P<d>\w*)\((?P<raw>.*?)\)(?P=d)"|"(?P<text>(?:[^"\\\n]|\\.)*)"|//[^\n]*|\'(?:[^\'\\]|\\.)\'|[^\s"]', re.S)
VERBS = "set|use|try|take|give|choose|refine|make|add|extend|pair|let|leave|move|lower|raise|apply|support|separate|mesh|improve|start"
ADVICE = re.compile(rf"(?:^|[;:,.(]|\bor|\band|\{{\}})\s*\b(?:{VERBS})\s[^;]*|smaller (?:time.step|cells|facets)[^;]*|finer mesh[^;]*", re.I)
# Settings of the method and of the mesh; a missing or conflicting key is not advice.
SETTING = re.compile(r"time\.|degree|refine|cells there|mass\b|scheme|multipliers?\b|sliding =|solver\.|law\b|steps?\b|pair_at|restitution|"
                     r"damping|edge_radius|initial_gap|saint-venant|\"p1\"|friction|smallest|expressions|side facets|set it to 0|to the group\b|extend the groups|\[\[support")
# Messages about files, directories, processes and programs, which no case affects.
OTHER = re.compile(r" -o\b|--|directory|another file|RICOCHET|ulimit|processes|ricochet::|file back|No |/fclib|this process|other threads|stop that run")
# Descriptions of keys and commands, which are not messages.
LEFT_OUT = {"reference.cpp", "manual_page.cpp", "main.cpp", "completion_scripts.cpp", "command_info.cpp", "plan.cpp", "command_validate.cpp"}


def literals(text):
    """Returns the literals of a text; adjacent literals count as one."""
    result, current = [], None
    for token in TOKEN.finditer(text):
        if token[0].startswith("//"):
            continue
        part = token["raw"] if token["raw"] is not None else token["text"]
        if part is None:
            if current is not None:
                result.append(current)
            current = None
        else:
            current = (current or "") + part.replace('\\"', '"')
    return result + ([current] if current is not None else [])


def advising_messages():
    """Returns (file, message) for all of them."""
    result = []
    for folder in ("src", "apps"):
        for path in sorted((SOURCE / folder).rglob("*.[ch]pp")):
            if path.name in LEFT_OUT or path.name.startswith("keys_table"):
                continue
            for message in literals(path.read_text(encoding="utf-8")):
                advice = ADVICE.search(message)
                if len(message) > 25 and advice and SETTING.search(advice[0]) and not OTHER.search(message):
                    result.append((path.name, message))
    return result
