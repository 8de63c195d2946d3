"""The messages in the sources that advise a setting: literals of C++ with a clause that begins with a verb such as "set"."""

import re

from harness import SOURCE

TOKEN = re.compile(r'R"(?P<d>\w*)\((?P<raw>.*?)\)(?P=d)"|"(?P<text>(?:[^"\\\n]|\\.)*)"|//[^\n]*|\'(?:[^\'\\]|\\.)\'|[^\s"]', re.S)
VERBS = "set|use|try|take|give|choose|refine|make|add|extend|pair|let|leave|move|lower|raise|apply|support|separate|mesh|improve|start"
ADVICE = re.compile(rf"(?:^|[;:,.(]|\bor|\band|\{{\}})\s*\b(?:{VERBS})\s[^;]*|smaller (?:time.step|cells|facets)[^;]*|finer mesh[^;]*", re.I)
# Settings of the method and of the mesh; that a key is missing, or is there beside another one, is no advice.
SETTING = re.compile(r"time\.|degree|refine|cells there|mass\b|scheme|multipliers?\b|sliding =|solver\.|law\b|steps?\b|pair_at|restitution|"
                     r"damping|edge_radius|initial_gap|saint-venant|\"p1\"|friction|smallest|expressions|side facets|set it to 0|to the group\b|extend the groups|\[\[support")
# Of files, directories, processes and programs: what a case says has no part in them.
OTHER = re.compile(r" -o\b|--|directory|another file|RICOCHET|ulimit|processes|ricochet::|file back|No |/fclib|this process|other threads|stop that run")
# What is written about keys and commands beforehand, and no message.
LEFT_OUT = {"reference.cpp", "manual_page.cpp", "main.cpp", "completion_scripts.cpp", "command_info.cpp", "plan.cpp", "command_validate.cpp"}


def literals(text):
    """Those that stand beside each other are one."""
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
    """(file, message) of all."""
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
