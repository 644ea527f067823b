"""Count candidates of compressed or private English in the sources; `plainness.py DIR [--list N] [--json FILE] [--kind K]`.

Every count is a candidate, not a verdict: a reader decides. The sum per 1 000 lines is the number to bring down.
`plainness.py DIR --comments` prints lines of code and of comments by folder, C included.
`plainness.py DIR --habits` counts habits of a translation in all texts of a folder.
`plainness.py DIR --reader` counts instead what a user reads: texts of console, errors, help and reports (strings and HTML
templates). `--draw 60 --seed 1` prints sentences of these texts, to be read by someone who does not know the code.
"""

from __future__ import annotations

import argparse
import ast
import collections
import io
import json
import random
import re
import tokenize
from pathlib import Path

NAMES = {
    "found": "say what: faults, rows, results, records",
    "one": "name the item: damper, output, line",
    "own": "name it: vehicle, points, values",
    "some": "subset, batch",
    "made": "built, elements, step_matrix",
    "given": "user_values, options",
    "place": "point, output_point, index",
    "places": "points, output_points",
    "taken": "used",
    "told": "known, stated",
    "what": "quantity, subject",
    "about": "description, metadata",
    "here": "block, sample_range",
    "rest": "remainder, residual",
    "known": "basis_coefficients, known_points",
    "most": "maximum",
    "least": "minimum",
    "together": "batch",
    "alone": "single",
    "many": "batch",
    "kind": "element_type (where it is a type)",
    "words": "message",
    "answers": "outputs",
    "drives": "inputs",
    "bends": "breakpoints",
    "reach": "sparsity, columns",
    "turning": "rotation",
    "heights": "plate_displacement",
}
"""Identifiers assigned in a function (also arguments and loop variables) that say nothing of the thing."""

PHRASES = {
    "as of X": r"\bas of (?:`|a |an |the |[A-Z])",
    "that answers": r"\b(?:that|which|what|with which|it) answers?\b|\banswers (?:the|a|it|as)\b",
    "what ... is/does": r"^(?:What|Where|When|How|Why|Whose|Which|Who)\b(?!.*\?)",
    "one of many": r"\b(?:each|every|any|the|this|that|an?other|no) one\b|\bone by one\b|\bones\b|: one\b|\bone (?:that|which|with|of its)\b",
    "own": r"\b(?:its|their|of its|an?|your|her) own\b|\bof your own\b|\bof its own\b",
    "such": r"\bsuch (?:a |an )?(?:one|file|thing|of|numbers|that)?\b",
    "does/do alone": r"\b(?:does|do|may|can|will|has|have|is|are) ?(?:[.,;:)]|$|, )|\bdoes it\b|\bthat do\b|\bthat may\b",
    "else/beside/behind": r"\bbeside\b|\bbehind (?:it|a|the|--|this)\b|\bbut for\b|\bsave for\b|\bwhere none\b|\bfor which none\b",
    "none/nothing": r"\b[Nn]one (?:is|are|of|where|for|that)\b|\bnothing (?:is|else|that)\b|\b(?:is|are) none\b",
    "personified": r"\b(?:says?|tells?|told|asks?|knows?|wants?|answers?|meets?|gives? way|takes? part|stands?|lies|looks)\b",
    "house words": r"\b(?:house|room|rooms|floor of|sentence|riddle|marched|march(?:es)?|lanes?|plates?' |trimmed|car of source \d)\b",
    "leading 'A ... into'": r"^(?:A|An|The) [\w ,-]+ (?:into|to|as|from) [\w ,-]+[.;]?$",
}
"""Phrases in docstrings, comments and messages."""

NEGATION = r"\b(?:not|no|never|none|nothing|nor|without|cannot|neither)\b"

READER_PHRASES = {
    "double negation": rf"(?!.*\b(?:[Nn]either|nor)\b){NEGATION}[^.;:,()]*{NEGATION}|\b(?:not|never) un\w+|\bnothing but\b|\bnone but\b",
    "two semicolons": r";[^.]*;",
    "condition behind a semicolon": r"; (?:if|unless|where|else|otherwise|but|and|or)\b",
    "as of": r"\bas of (?:a|an|the|those|most|during|\{)\b|\bthat of (?:a|an|the|those|its)\b[^.;:,]*\bthat of\b",
    "one as a noun": r"\b(?:[Ee]ach|[Ee]very|any|the|this|that|[Aa]nother|no|which|a \w+) one\b|\bones\b|\b[Oo]ne (?:that|which|with|of its|for|has|may|behind)\b|\bone by one\b",
    "range that may be one value": r"\{[^{}]*(?:min\(|\[0\])[^{}]*\} to \{",
    "five digits or more": r"\{[^{}]*:[+,]*\.?\d*\.[5-9][efg]?\}",
    "private word": r"\b(?:marche[ds]|marched|lanes|house|poses|knots?|riddle|told apart)\b",
    "elliptic": r"\b(?:does|do|may|has|is|are) ?(?:[.;]|$)|\bwhere none\b|\bif none\b|\bsuch (?:a|an) one\b|\bit is that\b|\bwhat it was\b",
}
"""Phrases in texts that a user reads, that newcomers did not understand; {name} is a value."""

HABITS = {
    "as before an example": r"(?:,| \() ?as (?!(?:if|well|soon|long|far|many|much|it|they|this|that|these|is|are|do|does|did|"
    r"was|were|in|at|of|for|by|on|with|when|to|before|after|shown|above|below|there|required|usual)\b|"
    r"(?:(?:an?|the) )?(?:[\w-]+ ){1,3}?(?:is|are|does|do|has|have|had|was|were|may|can|must|needs?)\b)",
    "chain of nouns": r"(?:\bof\b[^.;:,()\n]*){3,}\bof\b|\b(?:that|those) of\b",
    "inverted opening": r"(?:^|[.:;,] )(?:[Mm]ost |[Nn]ot )?(?:[Dd]ecisive|[Nn]eeded|[Aa]llowed|[Mm]issing|[Pp]ossible|"
    r"[Kk]nown|[Gg]iven|[Ff]ound|[Cc]omfortable|[Ss]tated|[Uu]sed|[Mm]eant|[Rr]efused|[Ll]eft out|[Cc]ounted|"
    r"[Oo]f (?:a|the|these|an)\b[^.;:,]{3,30}) (?:is|are|was|were)\b",
    "speaking thing": r"\b(?:says?|tells?|knows|forgets|said|told|asks)\b",
}
"""Habits of a translation: "X, as Y" for "for example Y", "that of the ... of the ...", "decisive is ride", "says so"."""

VERBS = re.compile(
    r"\b(?:is|are|was|were|be|been|has|have|had|do|does|did|can|may|must|will|would|should|could|"
    r"returns?|computes?|reads?|writes?|makes?|adds?|gives?|takes?|raises?|builds?|finds?|checks?|runs?|sets?|gets?|"
    r"holds?|keeps?|solves?|fits?|draws?|plots?|converts?|loads?|saves?|creates?|stores?|evaluates?|calculates?|"
    r"yields?|uses?|applies|apply|selects?|prints?|shows?|describes?|contains?|represents?|integrates?|advances?|"
    r"refuses?|rejects?|estimates?|interpolates?|assembles?|simulates?|optimises?|measures?|lists?|needs?|starts?|"
    r"stops?|ends?|moves?|turns?|changes?|removes?|replaces?|follows?|depends?|allows?|counts?|splits?|merges?|"
    r"combines?|compares?|scales?|maps?|maximum|require[sd]?|ensure[sd]?|parses?|opens?|closes?|sorts?|works?|"
    r"\w+(?:ify|ifies|ise|ises|ize|izes|ate|ates)|[a-z]+ed)\b",
    re.IGNORECASE,
)
"""A rough list: a first sentence of a function without any of these has no verb."""

PRONOUN = re.compile(
    r"\b(?:it|its|they|them|these|those|that|this|what|which|one|none|such|both|all|else|each)\b", re.IGNORECASE
)


def sentences(text: str) -> list[str]:
    """First-class sentences of a docstring's prose, without sections, formulas, and tables."""
    head = re.split(r"\n\s*(?:Args|Returns|Raises|Attributes|Yields):", text)[0]
    lines = [line for line in head.split("\n") if not line.startswith("    ") and "|" not in line]
    return [part.strip() for part in re.split(r"(?<=[.;:?])\s+", " ".join(lines)) if len(part.split()) > 2]


def strings(tree: ast.AST) -> list[tuple[int, str]]:
    """Messages: texts of raised errors, warnings, help, notices; f-strings with {} for values."""
    out = []
    for node in ast.walk(tree):
        values: list[ast.expr] = []
        if isinstance(node, ast.Raise) and isinstance(node.exc, ast.Call):
            values = list(node.exc.args)
        elif isinstance(node, ast.Call):
            values = [k.value for k in node.keywords if k.arg in ("help", "description", "why", "meaning", "epilog")]
        for value in values:
            if isinstance(value, ast.Constant) and isinstance(value.value, str):
                out.append((value.lineno, value.value))
            elif isinstance(value, ast.JoinedStr):
                parts = [str(v.value) if isinstance(v, ast.Constant) else "{}" for v in value.values]
                out.append((value.lineno, "".join(parts)))
    return out


def shown_texts(path: Path) -> list[tuple[int, str]]:
    """Texts of a file that a user may read: strings of at least four words of a module, or the prose of a template."""
    source = path.read_text(encoding="utf-8")
    if path.suffix == ".html":
        source = re.sub(
            r"\{\{-?\s*(.*?)\s*-?\}\}", r"{\1}", re.sub(r"\{[%#].*?[%#]\}", "", source, flags=re.S), flags=re.S
        )
        source = re.sub(r"\{(?:table|cells)\(.*?\)\}", "", source, flags=re.S)
        blocks = re.split(r"</?(?:p|li|td|th|div|caption|summary|label|span|h\d|option|button|dt|dd)\b[^>]*>", source)
        return [(1, text) for text in (" ".join(re.sub(r"<[^>]+>", "", b).split()) for b in blocks) if prose(text)]
    texts, nested = [], set[int]()
    tree = ast.parse(source)
    for node in ast.walk(tree):
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant):
            nested.add(id(node.value))
        if isinstance(node, ast.JoinedStr):
            nested |= {id(part) for part in node.values}
            for part in node.values:
                if isinstance(part, ast.FormattedValue) and part.format_spec is not None:
                    nested.add(id(part.format_spec))
    for node in ast.walk(tree):
        if id(node) in nested:
            continue
        if isinstance(node, ast.Constant) and isinstance(node.value, str):
            texts.append((node.lineno, node.value))
        elif isinstance(node, ast.JoinedStr):
            parts = [
                v.value if isinstance(v, ast.Constant) else ast.unparse(ast.JoinedStr([v]))[2:-1] for v in node.values
            ]
            texts.append((node.lineno, "".join(str(part) for part in parts)))
    return [(line, text) for line, text in texts if prose(text)]


PATTERN = re.compile(
    r"\\[bdws]|\w\|\w+\|\w+\||\n {4}|:root|\.\*(?!\.)|\(\?|\)\?|->|</|-src 'none'|^complete -|^autoload "
)
"""Texts that a program reads: search patterns, styles, sums of products over indices, markup, and shell scripts."""


def prose(text: str) -> bool:
    """True if a text is a sentence or part of one, and no formula, pattern or list of names; {name} is a value."""
    words = re.sub(r"\{[^{}]*(?:\{[^{}]*\}[^{}]*)*\}", "{}", text)
    count = len(re.findall(r"(?<![\w{.])[A-Za-z][a-z'-]+(?![\w}(=])", words))
    return count >= (3 if "{}" in words else 4) and not PATTERN.search(text)


def reader(files: list[Path]) -> tuple[float, dict[str, list[str]], list[str]]:
    """Rate of candidates per 1 000 words in what a user reads, the candidates by kind, and all sentences."""
    hits: dict[str, list[str]] = collections.defaultdict(list)
    words, every = 0, []
    for path in files:
        for line, text in shown_texts(path):
            words += len(text.split())
            for sentence in re.split(r"(?<=[.?!])\s+(?=[A-Z{])", text):
                every.append(f"{path}:{line} {sentence}")
                for name, pattern in READER_PHRASES.items():
                    if re.search(pattern, sentence):
                        hits[name].append(every[-1])
    return 1000 * sum(map(len, hits.values())) / max(words, 1), hits, every


def habits(files: list[Path]) -> dict[str, list[str]]:
    """Return the sentences of each kind of `HABITS`: texts that a user reads, docstrings and comments."""
    every = reader(files)[2]
    for path in files:
        if path.suffix == ".py":
            source = path.read_text(encoding="utf-8")
            every += [f"{path}:{line} {text}" for line, text in described(ast.parse(source), source)]
    return {
        kind: sorted({each for each in every if re.search(pattern, re.sub(r"\{.*?\}", "{}", each.partition(" ")[2]))})
        for kind, pattern in HABITS.items()
    }


WORDS = collections.Counter[str]()
"""Words of prose that were looked at: the measure for peers with fewer docstrings."""


MARKS = re.compile(r"# ?(?:noqa|type:|fmt:|pragma)")
"""Comments that tools read."""


def commented(path: Path) -> tuple[int, int]:
    """Lines of code of a file, docstrings aside, and lines that are a comment alone; of C within functions too."""
    source = path.read_text(encoding="utf-8")
    if path.suffix in (".c", ".h"):
        bare = re.sub(r"/\*.*?\*/|//[^\n]*", lambda match: "\n" * match[0].count("\n"), source, flags=re.S)
        code = [bool(line.strip()) for line in bare.split("\n")]
        return sum(code), sum(bool(line.strip()) for line in source.split("\n")) - sum(code)
    code_lines, comments, starts = set[int](), 0, True
    layout = {tokenize.NEWLINE, tokenize.INDENT, tokenize.DEDENT}
    for token in tokenize.generate_tokens(io.StringIO(source).readline):
        if token.type == tokenize.COMMENT:
            comments += token.line.lstrip().startswith("#") and not MARKS.match(token.string)
        elif token.type in layout:
            starts = True
        elif token.type not in (tokenize.NL, tokenize.ENDMARKER):
            # A string that begins a statement is a docstring.
            if not (starts and token.type == tokenize.STRING):
                code_lines.update(range(token.start[0], token.end[0] + 1))
            starts = False
    return len(code_lines), comments


def share_of_comments(folder: Path) -> tuple[int, int]:
    """Lines of code and of comments of a folder with all below it."""
    files = [path for path in sorted(folder.rglob("*")) if path.suffix in (".py", ".c", ".h")]
    counts = [commented(path) for path in files]
    return sum(code for code, _ in counts), sum(comments for _, comments in counts)


def described(tree: ast.AST, source: str) -> list[tuple[int, str]]:
    """Return the sentences of docstrings and the comments of a file, with their lines."""
    texts, seen = list[tuple[int, str]](), set[int]()
    for node in ast.walk(tree):
        if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef):
            text, line = ast.get_docstring(node) or "", getattr(node, "lineno", 1)
            texts += [(line, s) for s in sentences(text)]
            sections = re.split(r"\n\s*(?:Args|Returns|Raises|Attributes|Yields):", text)[1:]
            texts += [(line, s.strip()) for part in sections for s in part.split("\n") if s.strip()]
            seen |= {id(node.body[0])} if text else set()
        elif isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) and isinstance(node.value.value, str):
            # The docstring of a constant.
            texts += [] if id(node) in seen else [(node.lineno, s) for s in sentences(node.value.value)]
    for token in tokenize.generate_tokens(io.StringIO(source).readline):
        if token.type == tokenize.COMMENT and "noqa" not in token.string and "type:" not in token.string:
            texts.append((token.start[0], token.string.lstrip("# ")))
    return texts


def examine(path: Path) -> tuple[collections.Counter[str], list[tuple[str, int, str]]]:
    """Candidates of a file."""
    source = path.read_text(encoding="utf-8")
    tree = ast.parse(source)
    hits: list[tuple[str, int, str]] = []
    functions = [n for n in ast.walk(tree) if isinstance(n, ast.FunctionDef | ast.AsyncFunctionDef)]
    for f in functions:
        bound = {n.id: n.lineno for n in ast.walk(f) if isinstance(n, ast.Name) and isinstance(n.ctx, ast.Store)}
        bound |= {a.arg: a.lineno for a in ast.walk(f) if isinstance(a, ast.arg)}
        hits += [(f"name: {n}", line, f.name) for n, line in bound.items() if n in NAMES]
    for node in ast.walk(tree):
        if isinstance(node, ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef):
            for first in sentences(ast.get_docstring(node) or "")[:1]:
                WORDS["first lines"] += 1
                words = len(first.split())
                if isinstance(node, ast.FunctionDef) and not VERBS.search(first):
                    hits.append(("sentence without verb", node.lineno, first))
                if words >= 5 and len(PRONOUN.findall(first)) * 5 >= words:
                    hits.append(("riddle: pronouns for nouns", node.lineno, first))
    texts = [*described(tree, source), *strings(tree)]
    WORDS["prose"] += sum(len(text.split()) for _, text in texts)
    WORDS["functions"] += len(functions)
    for line, text in texts:
        for name, pattern in PHRASES.items():
            if re.search(pattern, text):
                hits.append((name, line, text))
    return collections.Counter(kind for kind, _, _ in hits), hits


def rates(total: collections.Counter[str]) -> dict[str, float]:
    """Return the counts of the examined files as rates, which do not depend on the amount of code."""
    names = sum(count for kind, count in total.items() if kind.startswith("name:"))
    functions, first_lines = max(WORDS["functions"], 1), max(WORDS["first lines"], 1)
    return {
        "phrases per 1000 words of prose": 1000 * (sum(total.values()) - names) / max(WORDS["prose"], 1),
        "vague names per 100 functions": 100 * names / functions,
        "first lines of functions without a verb [%]": 100 * total["sentence without verb"] / functions,
        "riddles among first lines [%]": 100 * total["riddle: pronouns for nouns"] / first_lines,
    }


def main() -> None:
    """Print counts by kind and by package."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--list", type=int, default=0, metavar="N", help="also print N examples of each kind")
    parser.add_argument("--kind", default="", help="only kinds that begin so")
    parser.add_argument("--json", type=Path, help="write the counts, to compare with later")
    parser.add_argument("--worst", type=int, default=12, help="number of files to name")
    parser.add_argument("--comments", action="store_true", help="count lines of code and of comments, by folder")
    parser.add_argument("--reader", action="store_true", help="count what a user reads, HTML templates included")
    parser.add_argument("--habits", action="store_true", help="count habits of a translation")
    parser.add_argument("--draw", type=int, default=0, metavar="N", help="print N sentences that a user reads")
    parser.add_argument("--seed", type=int, default=1, help="seed of the draw (default 1)")
    options = parser.parse_args()
    if options.comments:
        for folder in [options.folder, *sorted(path for path in options.folder.rglob("*") if path.is_dir())]:
            code, comments = share_of_comments(folder)
            if code:
                print(f"{100 * comments / code:5.1f} %  {comments:5} comments, {code:6} lines of code  {folder}")
        return
    if options.reader or options.draw or options.habits:
        paths = [path for path in sorted(options.folder.rglob("*")) if path.suffix in (".py", ".html")]
        rate, kinds, every = reader(paths or [options.folder])
        if options.draw:
            print("\n".join(" ".join(text.split()) for text in random.Random(options.seed).sample(every, options.draw)))
            return
        kinds = habits(paths or [options.folder]) if options.habits else kinds
        for kind, found in sorted(kinds.items(), key=lambda item: -len(item[1])):
            print(f"{len(found):6} {kind}")
            if options.list and kind.startswith(options.kind):
                print(
                    "\n".join(f"       {text}" for text in found[:: max(len(found) // options.list, 1)][: options.list])
                )
        if not options.habits:
            print(f"{rate:.1f} per 1 000 words, {len(every)} sentences")
        return
    total: collections.Counter[str] = collections.Counter()
    per_file: dict[str, tuple[int, int]] = {}
    examples: dict[str, list[str]] = collections.defaultdict(list)
    lines = 0
    files = [options.folder] if options.folder.is_file() else sorted(options.folder.rglob("*.py"))
    for path in files:
        counts, hits = examine(path)
        size = len(path.read_text(encoding="utf-8").splitlines())
        lines += size
        total += counts
        per_file[str(path)] = (sum(counts.values()), size)
        for kind, line, text in hits:
            examples[kind].append(f"{path}:{line} {text}")
    names = {k: v for k, v in total.items() if k.startswith("name:")}
    rest = {k: v for k, v in total.items() if not k.startswith("name:")}
    print(f"{len(files)} files, {lines} lines")
    print(
        f"{sum(names.values()):6} functions x names: "
        + ", ".join(f"{k[6:]} {v}" for k, v in sorted(names.items(), key=lambda i: -i[1]))
    )
    for kind, count in sorted(rest.items(), key=lambda i: -i[1]):
        print(f"{count:6} {kind}")
    print(f"{sum(total.values()):6} in all, {1000 * sum(total.values()) / max(lines, 1):.1f} per 1 000 lines")
    print("; ".join(f"{name} {value:.1f}" for name, value in rates(total).items()) + f" ({WORDS['prose']} words)")
    for name, (count, size) in sorted(per_file.items(), key=lambda i: -i[1][0] / max(i[1][1], 40))[: options.worst]:
        print(f"  {1000 * count / max(size, 1):6.0f} per 1 000 lines  {name}")
    for kind in sorted(examples):
        if options.list and kind.startswith(options.kind):
            print(f"\n## {kind}")
            step = max(len(examples[kind]) // options.list, 1)
            print("\n".join(examples[kind][::step][: options.list]))
    if options.json:
        options.json.write_text(json.dumps({"lines": lines, "counts": total}, indent=1, sort_keys=True))


if __name__ == "__main__":
    main()
