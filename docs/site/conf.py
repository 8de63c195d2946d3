"""The site: `./dev docs` builds it with Sphinx. Its pages are those of the repository (`include_patterns`), as they are read there,
and those of this folder. The source is build/site-source, a folder of links to the repository's, in which index.md of this folder is at the root:
the first page of the site is index.html."""

import os
import pathlib
import re
import shutil
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, os.environ.get("RICOCHET_PYTHON_PACKAGE", str(ROOT / "build/python")))

project = "Ricochet"
author = "The Ricochet authors"
copyright = author
version = release = re.search(r"project\(ricochet VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text()).group(1)

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "sphinx.ext.mathjax", "breathe", "sphinx_copybutton"]
root_doc = "index"
include_patterns = ["index.md", "docs/*.md", "docs/tutorials/*.md", "docs/developers/*.md", "docs/site/*.rst", "cases/README.md", "cases/*/README.md",
                    "benchmarks/README.md", "benchmarks/*/README.md", "bench/*/README.md", "examples/README.md", "CHANGELOG.md", "CONTRIBUTING.md"]
html_theme = "furo"
html_title = f"Ricochet {release}"
html_static_path = ["static"]
# Formulas are set by Debian's KaTeX, a copy of which is in the site: nothing of it is loaded from elsewhere. Sphinx writes them as
# for MathJax, which KaTeX reads, too.
KATEX = pathlib.Path("/usr/share/javascript/katex")
html_css_files = ["ricochet.css", "katex/katex.min.css"]
html_js_files = [(name, {"defer": "defer"}) for name in ("katex/katex.min.js", "katex/contrib/auto-render.js")]
mathjax_path = "set-formulas.js"
html_show_sphinx = False
myst_enable_extensions = ["dollarmath", "deflist"]
myst_heading_anchors = 4
html_copy_source = False
# Of a block of commands and what they print, the commands are copied.
copybutton_prompt_text = "$ "
copybutton_line_continuation_character = "\\"
smartquotes_action = "qe"  # two hyphens are an option's, no dash
source_suffix = {".md": "markdown", ".rst": "restructuredtext"}
# What the pages say in words for terminals is no language that Pygments knows.
highlight_language = "none"
autodoc_member_order = "bysource"
autodoc_typehints = "description"
breathe_projects = {"ricochet": os.environ.get("RICOCHET_DOXYGEN_XML", str(ROOT / "build/doxygen/xml"))}
breathe_default_project = "ricochet"
breathe_default_members = ("members",)


# In the site both are its index.
FIRST_PAGES = (ROOT / "docs/site/index.md", ROOT / "README.md")


def as_sphinx_reads_it(app, name, source):
    """Formulas in fences as the repository shows them, links to folders, of which a site has no page, and links from and to the index,
    which is docs/site/index.md in the repository."""
    if name == root_doc:
        source[0] = source[0].replace("](../../", "](").replace("](../", "](docs/")
    text = re.sub(r"\$`([^`]*)`\$", r"$\1$", source[0].replace("```math", "```{math}"))
    here = (ROOT / name).parent

    def shown(match):
        words, target = match.groups()
        if "://" in target or target[0] == "#":
            return match.group(0)
        path = here / target.split("#")[0]
        if path.resolve() in FIRST_PAGES:
            return f"[{words}]({os.path.relpath(ROOT / 'index.md', here)})"
        return words if path.is_dir() else match.group(0)

    source[0] = re.sub(r"\[([^\]\n]+)\]\(([^)\s]+)\)", shown, text)


def copy_katex(app):
    if app.builder.format == "html":
        shutil.copytree(KATEX, pathlib.Path(app.outdir) / "_static" / "katex", dirs_exist_ok=True)


def setup(app):
    app.connect("builder-inited", copy_katex)
    app.connect("source-read", as_sphinx_reads_it)
