"""The slots as the kernel calls them, against what the laws declare and what is compiled."""

import inspect
from types import SimpleNamespace

import pytest

from saleg.compiler.compiled_engine import kernel_for
from saleg.kernel import slots
from saleg.laws.base import CHAMBER_SLOTS, ENGINE_SLOTS
from saleg.laws.control.base import CONTROL_SLOTS, SAMPLED_SLOTS, ActuatorLaw, ConverterLaw

#: Those of a controller are compiled apart from the engine.
OF_A_CONTROLLER = {**CONTROL_SLOTS, **SAMPLED_SLOTS}
BEFORE_THE_ENGINE = {base.slot: base for base in (ActuatorLaw, ConverterLaw)}
WHOLE_ENGINE = {**ENGINE_SLOTS, **OF_A_CONTROLLER, **BEFORE_THE_ENGINE}


def declared(bases):
    return [(slot, base, method) for slot, base in bases.items() for method in base.compiled]


def parameters(function):
    return list(inspect.signature(function).parameters)


def calls_of(slots_of):
    """Names of the functions the kernel has for the methods of some slots."""
    for slot, base, method in declared(slots_of):
        yield f"{slot}_{method}"
        if method in base.at_every_step:
            yield f"{slot}_{method}_constants"


def test_there_is_a_function_for_every_method_and_no_other():
    functions = {
        name
        for name, item in vars(slots).items()
        if inspect.isfunction(item) and item.__module__ == slots.__name__ and name[0] != "_"
    }
    wanted = {*calls_of(CHAMBER_SLOTS), *calls_of(WHOLE_ENGINE)}
    assert functions - {"call_at"} == wanted


@pytest.mark.parametrize(
    ("slot", "base", "method"), [*declared(CHAMBER_SLOTS), *declared(WHOLE_ENGINE)]
)
def test_a_function_hands_the_arguments_of_its_method_on(slot, base, method):
    function = getattr(slots, f"{slot}_{method}")
    names = parameters(getattr(base, method))[1:]
    before = ["P", "side"] if slot in CHAMBER_SLOTS else ["P"]
    after = ["logarithms"] if method in base.at_every_step else []
    assert parameters(function) == [*before, *names, *after]

    def law(name):
        return SimpleNamespace(**{slot: SimpleNamespace(**{method: lambda *a: (name, *a)})})

    if slot in CHAMBER_SLOTS:
        engine = SimpleNamespace(left=law("left"), right=law("right"))
        assert function(engine, 0, *names) == ("left", *names)
        assert function(engine, 1, *names) == ("right", *names)
        if after:
            constants = getattr(slots, f"{slot}_{method}_constants")
            assert parameters(constants) == [*before, *names]
    else:
        assert function(law("engine"), *names) == ("engine", *names)


def test_composed_functions_take_the_same_number_of_arguments(base):
    module = kernel_for(base).module
    of_a_controller = {f"{slot}_{method}" for slot, _, method in declared(OF_A_CONTROLLER)}
    for name in {*calls_of(CHAMBER_SLOTS), *calls_of(WHOLE_ENGINE)} - of_a_controller:
        composed = getattr(module, name).py_func
        assert len(parameters(composed)) == len(parameters(getattr(slots, name))), name
