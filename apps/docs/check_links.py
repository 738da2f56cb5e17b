# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""check_links.py FOLDER: every link of the HTML pages to a file of the site, and to a place in it, is there.

Prints a line per dead link and ends with 1 if there is any, or if a page asks the network or a web server for something.
"""
import html.parser
import pathlib
import re
import sys
import urllib.parse


class Page(html.parser.HTMLParser):
    def __init__(self, path):
        super().__init__()
        self.places, self.links, self.loads = set(), [], []
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag, attributes):
        for name, value in attributes:
            if name in ("id", "name") and value:
                self.places.add(value)
            elif name in ("href", "src") and value:
                self.links.append(value)
                if tag in ("img", "script", "link"):
                    self.loads.append(value)
        if tag == "script" and ("type", "module") in attributes:
            self.loads.append("//a module, which no browser loads from a file")


def faults_of(root):
    pages = {path: Page(path) for path in sorted(root.rglob("*.html"))}
    for path in sorted(root.rglob("*.css")):
        for load in re.findall(r"url\([\"']?((?:https?:|/)[^)]*)\)", path.read_text(encoding="utf-8")):
            yield f"{path.relative_to(root)}: loads {load}"
    for path in sorted(root.glob("_static/scripts/*.js")):
        if path.read_text(encoding="utf-8").startswith("import "):
            yield f"{path.relative_to(root)}: imports a module, which no browser does from a file"
    links = 0
    for path, page in pages.items():
        for load in page.loads:
            if load.startswith(("http:", "https:", "//")):
                yield f"{path.relative_to(root)}: loads {load}"
        for link in page.links:
            parsed = urllib.parse.urlsplit(link)
            if parsed.scheme or parsed.netloc:
                continue
            links += 1
            target = (path.parent / urllib.parse.unquote(parsed.path)).resolve() if parsed.path else path
            if target.is_dir():
                target /= "index.html"
            place = urllib.parse.unquote(parsed.fragment)
            if not target.exists():
                yield f"{path.relative_to(root)}: there is no {link}"
            elif place == "nested-classes":
                continue  # Doxygen 1.9 links to their list where all are private
            elif place and target in pages and place not in pages[target].places:
                yield f"{path.relative_to(root)}: no such place: {link}"
    print(f"{len(pages)} pages, {links} links between them", file=sys.stderr)


if __name__ == "__main__":
    faults = list(faults_of(pathlib.Path(sys.argv[1]).resolve()))
    print("\n".join(faults))
    sys.exit(1 if faults else 0)
