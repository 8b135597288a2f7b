"""What every variable of every file must carry."""


def check_variable(variable, dimensions, units):
    """A variable has these dimensions and units, and more than one value."""
    assert variable.dims == dimensions
    assert variable.attrs["units"] == units
    assert variable.size > 1


def check_labels(data):
    """All variables of a file have long names and, but for labels and flags, units."""
    for name, variable in data.variables.items():
        assert variable.attrs.get("long_name"), name
        if variable.dtype.kind == "f":
            assert variable.attrs.get("units"), name
