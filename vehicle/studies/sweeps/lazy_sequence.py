"""Sequence whose items are made when they are used, so that millions of items take no memory."""

from abc import abstractmethod
from collections.abc import Iterator, Sequence
from typing import TypeVar, overload

T = TypeVar("T")


class LazySequence(Sequence[T]):
    """Sequence whose items are made when they are used."""

    @abstractmethod
    def item(self, number: int) -> T:
        """Make an item; `number` is from 0 to below the length."""

    @overload
    def __getitem__(self, number: int) -> T: ...
    @overload
    def __getitem__(self, number: slice) -> list[T]: ...
    def __getitem__(self, number: int | slice) -> T | list[T]:
        """Return an item, or a list of the items of a slice."""
        if isinstance(number, slice):
            return [self.item(index) for index in range(len(self))[number]]
        return self.item(number if 0 <= number < len(self) else range(len(self))[number])

    def __iter__(self) -> Iterator[T]:
        """Return the items in their order."""
        return map(self.item, range(len(self)))
