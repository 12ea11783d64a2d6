"""The templates of this folder, filled."""

import functools
import re
from typing import Any


def render(template: str, **values: Any) -> str:
    """A template of this folder with these values; texts among them are escaped."""
    return _templates().get_template(template).render(**values)


@functools.cache
def _templates() -> Any:
    from jinja2 import Environment, PackageLoader, StrictUndefined

    templates = Environment(
        loader=PackageLoader("mesokit.report", "document"),
        autoescape=True,
        trim_blocks=True,
        lstrip_blocks=True,
        undefined=StrictUndefined,
    )
    templates.filters["marked"] = marked
    return templates


def marked(text: str) -> Any:
    """A unit or a few words as HTML: raised powers, lowered indices, Greek tau.

    >>> print(marked("a^2/tau"), marked("m/(a^(d-2) tau)"), marked("speed v_x"), marked("<%>"))
    a<sup>2</sup>/τ m/(a<sup>d-2</sup> τ) speed v<sub>x</sub> &lt;%&gt;
    """
    from markupsafe import Markup, escape

    shown = re.sub(r"\btau\b", "τ", str(escape(text)))
    shown = re.sub(r"\^(?:\(([^)]*)\)|(-?\w+))", r"<sup>\1\2</sup>", shown)
    shown = re.sub(r"\b([A-Za-z])_(\w{1,2})\b", r"\1<sub>\2</sub>", shown)
    return Markup(shown)
