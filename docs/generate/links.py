"""Every link of the built site leads somewhere, and nothing is fetched from elsewhere."""

from __future__ import annotations

from html.parser import HTMLParser
from pathlib import Path
from typing import Any
from urllib.parse import unquote, urlsplit

from mkdocs.exceptions import Abort
from mkdocs.plugins import event_priority

LINKS = {"a": "href", "link": "href", "img": "src", "script": "src", "video": "src"}


class Page(HTMLParser):
    """The links of a page, what it fetches, and its anchors."""

    def __init__(self, path: Path) -> None:
        super().__init__()
        self.links: list[tuple[str, str]] = []
        self.anchors = {""}
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        given = {name: value or "" for name, value in attrs}
        self.anchors.update(given[name] for name in ("id", "name") if name in given)
        if (link := given.get(LINKS.get(tag, ""))) is not None:
            self.links.append((tag, link))


@event_priority(-200)  # after all that writes files
def on_post_build(config: Any) -> None:
    """Raise Abort with every link that is broken."""
    site = Path(config["site_dir"])
    pages = {path.resolve(): Page(path) for path in site.rglob("*.html")}
    broken = [
        f"{path.relative_to(site.resolve())}: {link}: {reason}"
        for path, page in pages.items()
        for tag, link in page.links
        if (reason := _wrong(tag, link, path, pages))
    ]
    if broken:
        raise Abort("broken links:\n" + "\n".join(sorted(set(broken))))


def _wrong(tag: str, link: str, here: Path, pages: dict[Path, Page]) -> str:
    parts = urlsplit(link)
    if parts.scheme or parts.netloc:
        return "" if tag == "a" or parts.scheme == "data" else "fetched from elsewhere"
    target = (here.parent / unquote(parts.path)).resolve() if parts.path else here
    if here.name == "404.html" and link.startswith("/"):
        return ""  # made for a server
    if target.is_dir():
        target = target / "index.html"
    if not target.exists():
        return "no such file"
    anchor = unquote(parts.fragment)
    if target in pages and anchor not in pages[target].anchors:
        return "no such anchor"
    return ""
