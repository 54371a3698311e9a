# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""How Sphinx renders the site. tools/make-site.py stages the pages and calls Sphinx with this file beside them."""
import os

project = "Talus"
author = "The Talus authors"
project_copyright = "The Talus authors, GNU General Public License 3 or later"
version = release = os.environ.get("TALUS_VERSION", "")

extensions = ["myst_parser"]
myst_enable_extensions = ["html_image"]
myst_heading_anchors = 4          # as GitHub names them, so that one link serves both
source_suffix = {".md": "markdown"}
root_doc = "docs/index"
exclude_patterns = []

smartquotes = False                # keys and values are shown as they are typed

html_theme = "furo"
html_title = f"Talus {version}".strip()
html_copy_source = False
html_show_sourcelink = False
html_show_search_summary = False  # it would be fetched, which a browser refuses for file://
html_permalinks_icon = "#"
pygments_style = "tango"
html_theme_options = {"navigation_with_keys": True}

# Pages of a repository draw mermaid; the site shows its text, which Pygments has no lexer for.
from pygments.lexers.special import TextLexer  # noqa: E402
from sphinx.highlighting import lexers  # noqa: E402

lexers["mermaid"] = TextLexer()
