"""Tables of pages of docs/ that benchmarks write."""

import re


def write_parts(page, parts):
    """Puts each part of {name: text} between the marks <!-- name --> and <!-- end --> of the page."""
    text = page.read_text(encoding="utf-8")
    for name, content in parts.items():
        pattern = re.compile(f"(<!-- {name} -->\n).*?(<!-- end -->)", re.S)
        if not pattern.search(text):
            raise SystemExit(f"{page}: has no place for \"{name}\"")
        text = pattern.sub(lambda match: match[1] + content + "\n" + match[2], text)
    page.write_text(text, encoding="utf-8")
