"""Mutations of a text for `python -m tests.fuzz`."""

import random
import re

WORDS = (
    "nan", "inf", "-inf", "1e400", "-1", "0", "1e-300", "1e300", "1e30", "true", "''", '"x"', "[", "]", "[1,2]", "{}",
    "[1,2,3]", "[nan,0,0]", "\0", "é", "\ufeff", "1,5", "#N/A", "0x10", "1_000", "--", "=", ".", "..", "9" * 400,
    "[" * 1500, '"' * 3, "\\u0000", "-0.0", "1e-9", "1e9", "None", "\r", "\t",
)  # fmt: skip
NUMBERS = re.compile(r"(?<![\w.])-?\d+\.?\d*(?:e[+-]?\d+)?")


def mutated(text: str, rng: random.Random) -> str:
    """A text with one to three of: a word put in, a number replaced, a line lost, doubled, swapped or cut, a byte."""
    for _ in range(rng.randint(1, 3)):
        lines = text.split("\n")
        at = rng.choice([0, min(1, len(lines) - 1), rng.randrange(len(lines)), len(lines) - 1])
        match rng.randrange(8):
            case 0:
                place = rng.randrange(len(text) + 1)
                text = text[:place] + rng.choice(WORDS) + text[place:]
            case 1 | 2:
                found = list(NUMBERS.finditer(text))
                if found:
                    one = rng.choice(found)
                    text = text[: one.start()] + number(rng, one.group()) + text[one.end() :]
            case 3:
                text = "\n".join(lines[:at] + lines[at + 1 :])
            case 4:
                text = "\n".join([*lines[:at], lines[at], *lines[at:]])
            case 5:
                lines[at] = (
                    lines[at][::-1] if rng.random() < 0.3 else lines[at].replace(",", rng.choice([";", "", ",,"]))
                )
                text = "\n".join(lines)
            case 6:
                text = text[: rng.randrange(len(text) + 1)]
            case 7:
                other = rng.randrange(len(lines))
                lines[at], lines[other] = lines[other], lines[at]
                text = "\n".join(lines)
    return text


def number(rng: random.Random, old: str) -> str:
    """Another number or word instead of a number."""
    scaled = float(old) * 10.0 ** rng.uniform(-6.0, 6.0) * rng.choice([1.0, 1.0, -1.0])
    return rng.choice([rng.choice(WORDS), f"{scaled:.6g}", f"{float(old) * rng.uniform(0.5, 2.0):.6g}"])
