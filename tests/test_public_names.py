"""Public names: docstrings with summary, parameters and units; each in the reference, once."""

import enum
import importlib
import inspect
import re

import pytest

from helpers import ROOT

#: Packages and modules a user imports from.
PUBLIC = (
    "saleg",
    "saleg.calibration",
    "saleg.continuation",
    "saleg.control",
    "saleg.design",
    "saleg.design.formulas",
    "saleg.errors",
    "saleg.export",
    "saleg.fuels",
    "saleg.fundamental",
    "saleg.laws",
    "saleg.machines",
    "saleg.optimize",
    "saleg.plotting",
    "saleg.plotting.branches",
    "saleg.plotting.control",
    "saleg.plotting.design",
    "saleg.plotting.fundamental",
    "saleg.plotting.measured",
    "saleg.plotting.optimisation",
    "saleg.plotting.sensitivity",
    "saleg.plotting.studies",
    "saleg.plotting.sweeps",
    "saleg.plugs",
    "saleg.plugs.gymnasium",
    "saleg.quantities",
    "saleg.reference",
    "saleg.reporting",
    "saleg.sensitivity",
    "saleg.start",
    "saleg.studies",
    "saleg.sweep",
    "saleg.thesis.appendix_c",
    "saleg.thesis.beside",
    "saleg.thesis.chapter_2",
    "saleg.thesis.chapter_3",
    "saleg.thesis.chapter_4",
    "saleg.thesis.chapter_5",
    "saleg.thesis.chapter_5.figures",
    "saleg.thesis.claims",
    "saleg.thesis.figures",
    "saleg.thesis.optimisation",
    "saleg.thesis.printed_tables",
    "saleg.thesis.prototypes",
    "saleg.thesis.tables",
    "saleg.thesis.walls",
)
#: A unit in a description: ``[m/s]``, ``[-]``, "in the unit of the figure".
UNIT = re.compile(r"\[[^\]]+\]|in (its|that|the)( SI)? unit|square of its unit", re.IGNORECASE)
#: A number that is a flag or a count: "1 for a motor, 0 for a generator".
FLAG = re.compile(r"\b[01]\b|zero")


def names_of(module):
    """Public names of a module: those it lists, or those it defines."""
    if hasattr(module, "__all__"):
        return module.__all__
    return [
        name
        for name, value in vars(module).items()
        if not name.startswith("_") and getattr(value, "__module__", None) == module.__name__
    ]


def public_callables():
    """Each public function and class once, by its first public name."""
    found = {}
    for name in PUBLIC:
        module = importlib.import_module(name)
        for attribute in names_of(module):
            value = getattr(module, attribute)
            if inspect.isfunction(value) or inspect.isclass(value):
                found.setdefault(value, f"{name}.{attribute}")
    return {name: value for value, name in found.items()}


def reference():
    """Directive, full name and value of everything the pages of the reference describe."""
    for page in sorted((ROOT / "docs" / "api").glob("*.rst")):
        for kind, name in re.findall(
            r"^\.\. (\w+):: (\S+)$", page.read_text("utf-8"), re.MULTILINE
        ):
            if kind == "currentmodule":
                module = importlib.import_module(name)
            else:
                yield kind, f"{module.__name__}.{name}", getattr(module, name)


REFERENCE = list(reference())
CALLABLES = public_callables()
FUNCTIONS = {name: value for name, value in CALLABLES.items() if inspect.isfunction(value)}
CLASSES = {name: value for name, value in CALLABLES.items() if inspect.isclass(value)}


def section(text, title):
    """Text of a section of a numpydoc docstring, without its title."""
    found = re.search(rf"^{title}\n-+\n(.*?)(?=^\S[^\n]*\n-+\n|\Z)", text, re.M | re.S)
    return found[1] if found else ""


def entries(text):
    """Names, type and description of each entry of a section."""
    _, *parts = re.split(r"^(\S[^\n]*)$", text, flags=re.M)
    for head, description in zip(parts[::2], parts[1::2], strict=True):
        names, _, kind = head.partition(" : ")
        yield [name.strip() for name in names.split(",")], kind, description


def described(text, *titles):
    return [
        name for title in titles for names, *_ in entries(section(text, title)) for name in names
    ]


def without_units(text):
    """Entries for plain floats whose description, or summary for what is returned, has no unit."""
    summary = text.partition("\n")[0]
    return [
        names
        for title in ("Parameters", "Attributes", "Returns")
        for names, kind, description in entries(section(text, title))
        if re.fullmatch(r"(float|array)(, optional)?", kind or names[0])
        and not UNIT.search(description + (summary if title == "Returns" else ""))
    ]


def signature(value):
    """Parameters as a docstring writes them, without ``self``."""
    stars = {inspect.Parameter.VAR_POSITIONAL: "*", inspect.Parameter.VAR_KEYWORD: "**"}
    parameters = inspect.signature(value).parameters.values()
    return [stars.get(p.kind, "") + p.name for p in parameters if p.name not in ("self", "cls")]


def members(kind):
    """Public methods and properties a class defines itself, with the function behind each."""
    for name, value in vars(kind).items():
        value = getattr(value, "fget", None) or getattr(value, "__func__", None) or value
        if not name.startswith("_") and inspect.isfunction(value):
            yield name, value


@pytest.mark.parametrize("name", CALLABLES)
def test_the_docstring_begins_with_a_summary(name):
    first, _, rest = inspect.getdoc(CALLABLES[name]).partition("\n")
    assert first.endswith((".", ":", "``."))
    assert not rest or rest.startswith("\n")


@pytest.mark.parametrize("name", FUNCTIONS)
def test_a_function_describes_its_parameters(name):
    assert described(inspect.getdoc(FUNCTIONS[name]), "Parameters") == signature(FUNCTIONS[name])


@pytest.mark.parametrize("name", CLASSES)
def test_a_class_describes_its_parameters_and_members(name):
    kind = CLASSES[name]
    for member, function in members(kind):
        text = inspect.getdoc(getattr(kind, member))
        assert text, member
        assert described(text, "Parameters") in ([], signature(function)), member
    if not issubclass(kind, BaseException | enum.Enum) and not getattr(kind, "_is_protocol", False):
        shown = [value for *_, value in REFERENCE]
        texts = [inspect.getdoc(one) for one in kind.__mro__ if one in shown]
        known = {one for text in texts for one in described(text, "Parameters", "Attributes")}
        assert not set(signature(kind)) - known


@pytest.mark.parametrize("name", CALLABLES)
def test_numbers_have_units(name):
    value = CALLABLES[name]
    functions = [value] if inspect.isfunction(value) else [one for _, one in members(value)]
    for one in {value, *functions}:
        assert not without_units(inspect.getdoc(one) or "")
    for one in functions:
        if one.__annotations__.get("return") == "float":
            text = inspect.getdoc(one) or inspect.getdoc(getattr(value, one.__name__))
            assert UNIT.search(text) or FLAG.search(text), one.__name__


def test_the_reference_has_every_public_name_once():
    """Names that two packages share stand with one of them."""
    names = [value for kind, _, value in REFERENCE if kind != "autodata"]
    assert len(names) == len(set(names))
    assert set(CALLABLES.values()) <= set(names)
    bases = {base for kind in CLASSES.values() for base in kind.__mro__}
    assert set(names) - set(CALLABLES.values()) <= bases
    data = {name for kind, name, _ in REFERENCE if kind == "autodata"}
    for name in PUBLIC:
        module = importlib.import_module(name)
        for attribute in getattr(module, "__all__", ()):
            value = getattr(module, attribute)
            told = inspect.ismodule(value) or inspect.isfunction(value) or inspect.isclass(value)
            assert told or f"{name}.{attribute}" in data | {"saleg.__version__"}
