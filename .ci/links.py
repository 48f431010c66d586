"""Finds dead links, pages without a title, and pages that search does not find, in a built manual.

usage: links.py FOLDER

Links lead to files and their anchors: within the manual, and from it to files of the checkout. Addresses of other sites are
not opened. Exits with 1 and a line for each dead link.
"""

import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit


class Page(HTMLParser):
    """Links and anchors of a page."""

    def __init__(self, path):
        super().__init__()
        self.path, self.links, self.anchors = path, set(), {""}
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag, attributes):
        given = dict(attributes)
        self.anchors.update(given[key] for key in ("id", "name") if given.get(key))
        self.links.update(given[key] for key in ("href", "src") if given.get(key))


def dead(page, pages):
    """Returns the links of a page that lead nowhere."""
    for link in sorted(page.links):
        parts = urlsplit(link)
        if parts.scheme or parts.netloc:
            continue
        target = (page.path.parent / unquote(parts.path)).resolve() if parts.path else page.path
        if not target.exists():
            yield f"{page.path.name}: {link}: no such file"
        elif target in pages and unquote(parts.fragment) not in pages[target].anchors:
            yield f"{page.path.name}: {link}: no such anchor"


def main(folder):
    root = Path(folder).resolve()
    pages = {path: Page(path) for path in sorted(root.glob("*.html"))}
    chapters = [path for path in pages if path.stem not in ("404", "print", "toc")]
    wrong = [line for page in pages.values() for line in dead(page, pages)]
    index = "".join(path.read_text(encoding="utf-8") for path in root.glob("searchindex*.js"))
    wrong += [f"{path.name}: search does not find it" for path in chapters if f"{path.name}#" not in index]
    print("\n".join(wrong) or f"{len(chapters)} pages, {sum(len(page.links) for page in pages.values())} links, none dead")
    return bool(wrong) or len(chapters) < 20


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
