"""Laws that a page or an example registers belong to it alone: two pages may take the same name."""

from typing import Any

import pytest

from vehicle.model.laws import friction_by_address, law_by_address

KEPT: list[Any] = []


@pytest.fixture(autouse=True)
def names_of_its_own(monkeypatch):
    for module in (law_by_address, friction_by_address):
        names: dict[str, Any] = {}
        KEPT.append(names)  # a car of an earlier page may still call its function
        monkeypatch.setattr(module, "_LAWS", names)
