"""Nothing is kept that nobody calls: what only its own definition names goes."""

from vulture import Vulture

CODE = (
    "firmware/zerorate",
    "drivers/zerorate_i2c",
    "tools/zerorate_tools",
    "tools/zerorate_bench",
    "host_tests",
    "examples",
)
GENERATED = ("*/zerorate/native/*",)
#: Called by others: pytest, Python, its import, a template of the report, a program sent as text,
#: whoever uses the fakes as if they were the real bus.
CALLED_BY_OTHERS = {
    *("pytest_configure", "pytest_terminal_summary"),
    *("busio_i2c", "polled", "impatient"),
    *("__getattr__", "__dir__", "handle_starttag", "handle_data"),
    *("_constant", "_subscript", "_binop", "_unaryop", "_boolop", "_ifexp"),
    *("how_sure", "found_in_short", "write_device", "make_folders", "put_in_place"),
    *("unlock", "enable_pec", "block_process_call", "get_code"),
}


def test_every_function_and_class_is_used(repository):
    """One walk of all files, about 8 s of CPU time."""
    # what the decorator registers is called by its list
    vulture = Vulture(ignore_decorators=["@log"])
    vulture.scavenge([str(repository / folder) for folder in CODE], exclude=GENERATED)
    kinds = ("function", "method", "class", "property", "unreachable_code")
    unused = {
        i.name: f"{i.filename}:{i.first_lineno}"
        for i in vulture.get_unused_code()
        if i.typ in kinds
    }
    assert {n: where for n, where in unused.items() if n not in CALLED_BY_OTHERS} == {}
    assert unused, "it finds nothing at all"
