"""Damaged specifications, as bytes: characters, tokens, declarations, sizes and encodings."""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import cache
from pathlib import Path
from random import Random

from tests.clauses.generate import random_pair
from tests.generate import random_text
from tests.profiles import PROFILES
from tests.shorthand import shorthand
from tests.syntax.mutations import SNIPPETS, mutations

EXAMPLES = Path(__file__).parents[2] / "examples"

STRANGE: tuple[str, ...] = (
    *map(chr, (0, 8, 11, 12, 13, 26, 27, 28, 29, 30, 31, 127, 0x80, 0x85, 0x9F, 0xA0, 0xAD, 0x1680, 0x180E, 0x2000)),
    *map(chr, (0x200B, 0x200C, 0x200D, 0x200E, 0x2028, 0x2029, 0x202E, 0x202F, 0x205F, 0x2060, 0x2066, 0x3000, 0xFEFF)),
    *"é²٣߁４Ａıſ", "a\u0308", "\U0001d7d8", "\U0001f916", "\ufffd", "\uffff", "\r", "\r\n", "\n\r", "\t", " ", ".", "-",
    *"+_=;#'\"\\/*[]{}<>|&!?$%", "..", "!=", "<=", "{R}", "{}", "{R-1}", "_{R}",
)  # fmt: skip
"""Spaces, line ends, digits and letters that may be taken for others, and signs that the language does not have."""

KEYWORDS = tuple(
    """BEGIN END AND OR NOT IF THEN IFONLYIF STATE VECTOR ALIASES RESOURCES ACTIONS REACTION RULES ASSUMPTIONS START
    GOALS CONFIG state can be define as resource action duration cost controlled resources preconditions nominal effects
    alternative none rule assume start goal type priority constraint when then max_plan_length effect_ordering any first
    is executing true false for end in all some exactly one where not severity restoration
    R {R} {R+1} P_{R}""".split()  # noqa: SIM905 - a page of quotes says no more
)

PIECE = re.compile(r"\s+|//[^\n]*|/\*.*?\*/|\w+|.", re.DOTALL)

Damage = Callable[[str, Random], str]


CONDITIONAL = tuple(
    f"""BEGIN STATE VECTOR
    state S_Level can be 0..5 state when can be when, not state S_r1 can be x, y state S_r2 can be x, y
    END STATE VECTOR BEGIN ACTIONS action go preconditions: S_Level > 2 {effects} END ACTIONS"""
    for effects in (
        """nominal effects: S_Level is S_Level - 1
        when when is when: when is not when when is not: S_r1 is x""",
        """effects: when is when
        alternative effects: when S_r1 is not x: S_Level is S_Level + 1 when S_r2 is x: none""",
        """effects: for R in r1, r2 when S_{R} is x AND S_Level in {1, 3..4}: S_{R} is y end for
        alternative effects:""",
        """effects: S_r1 is y for N in 1..3 when S_Level = {N}: S_Level is S_Level -{N} end for duration: 1
        for R in r2, r1 action do_{R} effects: S_{R} is x end for action last effects: when S_r2 is x : S_r1 is x""",
        """effects: when all R in r1, r2: S_{R} is x: S_Level is S_Level-1 when NOT (some R in r1, r2: S_{R} is y): none
        alternative effects: S_Level is S_Level +2 when when is not : when is when action action effects: none""",
    )
)
"""Clauses in `for`, relative effects, and `when` as a name."""


@cache
def sources() -> tuple[str, ...]:
    """Specifications without a mistake: all examples, some of every profile, and some in short forms."""
    written = [path.read_text(encoding="utf-8") for path in sorted(EXAMPLES.glob("*.tum"))]
    small = [text for text in written if len(text) < 6000]
    texts = [random_text(seed, profile) for profile in PROFILES.values() for seed in range(25)]
    started = [_with_starts(text) if number % 4 == 0 else text for number, text in enumerate(texts)]
    conditional = (*(random_pair(seed).text for seed in range(60)), *CONDITIONAL)
    return (*small, *started, *(shorthand(seed)[0] for seed in range(80)), *conditional)


def _with_starts(text: str) -> str:
    """The text with start conditions: what its state rules say."""
    rules = re.findall(r"^ +rule: (.*)$", text.partition("BEGIN STATE RULES")[2].partition("END")[0], re.MULTILINE)
    return text + "".join(["BEGIN START\n", *(f"  start: {each}\n" for each in rules), "END START\n"])


def damaged(seed: int) -> bytes:
    """The text of a seed."""
    random = Random(f"text {seed}")
    text = random.choice(sources())
    if random.random() < 0.01:
        return _of_a_size(random).encode()
    if random.random() < 0.2:
        text = next(mutations(text, seed))
    else:
        for _ in range(random.choice((0, 1, 1, 1, 2, 3))):
            text = random.choice(DAMAGES)(text, random)
    return _encoded(text, random)


def _place(text: str, random: Random) -> int:
    return random.randint(0, len(text))


def _put_in(text: str, random: Random) -> str:
    """A strange character anywhere."""
    at = _place(text, random)
    return text[:at] + random.choice(STRANGE) + text[at:]


def _in_comment(text: str, random: Random) -> str:
    """A comment with a strange character, where white space stands."""
    spaces = [match.start() for match in re.finditer(r"\s", text)]
    at = random.choice(spaces)
    strange = random.choice(STRANGE)
    forms = ("// x{}y\n", "//{}", "/*{}*/", "/* x\n{} y */", "/*/{}/*/", "/**{}", "// /*{}\n", "*/{}", "/*")
    return text[:at] + random.choice(forms).format(strange) + text[at:]


def _other_space(text: str, random: Random) -> str:
    """Another character in place of white space."""
    spaces = [match.start() for match in re.finditer(r"\s", text)]
    for at in random.sample(spaces, random.choice((1, 1, 1, 5)) if len(spaces) > 5 else 1):
        text = text[:at] + random.choice(("\t", "\r", "\n", "", "", *STRANGE[:33]))[:1].ljust(1)[:1] + text[at + 1 :]
    return text


def _glued(text: str, random: Random) -> str:
    """Two tokens without the white space between them."""
    gaps = [match.span() for match in re.finditer(r"\s+", text)]
    start, end = random.choice(gaps)
    return text[:start] + text[end:]


def _digits(text: str, random: Random) -> str:
    """A number in other digits, or with something at its ends."""
    numbers = [match.span() for match in re.finditer(r"(?<!\w)\d+", text)]
    if not numbers:
        return _put_in(text, random)
    start, end = random.choice(numbers)
    number = text[start:end]
    spelled = (
        f"0{number}", "0" * 17 + number, "0" * 18 + number, f"-{number}", f"+{number}", f"- {number}", "-0", "0", "00",
        f"{number}.0", f"{number}.", f"{number}e0", f"{number}_0", f"{number}x", f"{number}é", f"0x{number}",
        f"{number},", f"{number}/**/", f"{number}//\n", f"{number}{number}", "1000000000", "1000000001", "9" * 18,
        "9" * 19, "9" * 5000,
        number.translate({ord(digit): 0x660 + int(digit) for digit in "0123456789"}), "४", "²", "Ⅳ", "4controlled",
    )  # fmt: skip
    return text[:start] + random.choice(spelled) + text[end:]


def _token(text: str, random: Random) -> str:
    """A token that is lost, doubled, exchanged for another one of the text, or for a word of the language."""
    pieces = PIECE.findall(text)
    tokens = [place for place, piece in enumerate(pieces) if not piece.isspace()]
    at, other = random.choice(tokens), random.choice(tokens)
    match random.randrange(6):
        case 0:
            pieces[at] = ""
        case 1:
            pieces[at] += " " + pieces[at]
        case 2:
            pieces[at], pieces[other] = pieces[other], pieces[at]
        case 3:
            pieces[at] = pieces[other]
        case 4:
            pieces[at] = random.choice(KEYWORDS)
        case _:
            pieces[at] = random.choice(("(", ")", ",", ":", "", ": ")) + pieces[at]
    return "".join(pieces)


def _renamed(text: str, random: Random) -> str:
    """A name that becomes a word of the language, or another name, wherever it stands."""
    names = sorted(set(re.findall(r"[A-Za-z_]\w*", text)) - set(KEYWORDS))
    old, new = random.choice(names), random.choice((*KEYWORDS, *KEYWORDS, *names, "_", "x" * 300, "é", "Nœud"))
    return re.sub(rf"\b{old}\b", new, text)


def _lines(text: str, random: Random) -> str:
    """A line that is lost, doubled or moved."""
    lines = text.split("\n")
    at, other = random.randrange(len(lines)), random.randrange(len(lines))
    match random.randrange(3):
        case 0:
            del lines[at]
        case 1:
            lines.insert(other, lines[at])
        case _:
            lines.insert(other, lines.pop(at))
    return "\n".join(lines)


def _block(text: str, random: Random) -> str:
    """A block that is lost, doubled, emptied or moved to the end."""
    blocks = [match.span() for match in re.finditer(r"BEGIN (\w+(?: VECTOR| RULES)?)\b.*?\bEND \1", text, re.DOTALL)]
    if not blocks:
        return _lines(text, random)
    start, end = random.choice(blocks)
    block, rest = text[start:end], text[:start] + text[end:]
    words = block.split()
    empty = " ".join(["BEGIN", *words[1 : 3 if words[1] in ("STATE", "REACTION") else 2]])
    chosen = (rest, f"{text}\n{block}", f"{rest}\n{block}", f"{rest}\n{empty} {empty.replace('BEGIN', 'END')}")
    return random.choice(chosen)


def _snippet(text: str, random: Random) -> str:
    """A piece of the language where white space stands."""
    at = random.choice([match.end() for match in re.finditer(r"\s", text)])
    pieces = (
        *SNIPPETS,
        "NOT ",
        "( ",
        "true AND ",
        "false OR ",
        "none, ",
        "none ",
        "/**/",
        "IF true THEN ",
        "goal: true ",
    )
    return text[:at] + random.choice(pieces) + text[at:]


def _predicate(text: str, random: Random) -> str:
    """A predicate in place of another."""
    atoms = [match.span() for match in re.finditer(r"\w+ is \w+", text)]
    if not atoms:
        return _snippet(text, random)
    start, end = random.choice(atoms)
    atom = text[start:end]
    forms = (
        f"({atom})", f"(({atom}))", f"NOT {atom}", f"NOT NOT {atom}", f"({atom} AND true)", f"({atom} OR false)",
        f"(IF true THEN {atom})", f"(IF {atom} THEN {atom} IFONLYIF {atom})", f"({atom} IFONLYIF true)",
        f"({atom} IFONLYIF IF true THEN {atom})", f"{atom} OR {atom} AND {atom}", f"IF {atom} THEN {atom}", "true",
        "false", f"{atom} IFONLYIF {atom}", "executing act0", "none", f"{atom}, {atom}", f"{atom},", "", "()",
    )  # fmt: skip
    return text[:start] + random.choice(forms) + text[end:]


def _respaced(text: str, random: Random) -> str:
    """Other white space and comments between tokens, which mean nothing."""
    pieces = PIECE.findall(text)
    gaps = [place for place, piece in enumerate(pieces) if piece.isspace()]
    for at in random.sample(gaps, min(len(gaps), 8)):
        pieces[at] = random.choice(
            (" ", "\n", "\t", "\r", "\r\n", "/**/", "//\n", "// é \r", "/* // */", "//*/\n", " /*/ */")
        )
    return "".join(pieces)


def _older(text: str, random: Random) -> str:
    """Older spellings, a space before a colon, fields and declarations in another order."""
    match random.randrange(4):
        case 0:
            return text.replace("duration:", "cost:").replace("nominal effects:", "effects:")
        case 1:
            return text.replace(":", " :")
        case 2:
            return re.sub(
                r"^(\s*duration.*)\n(.*(?:effects|preconditions|resources).*)$", r"\2\n\1", text, flags=re.MULTILINE
            )
        case _:
            return re.sub(r"^(rule|resource|assume|define)(.*)\n\1(.*)$", r"\1\3\n\1\2", text, flags=re.MULTILINE)


HEADER = re.compile(
    r"\b(for|all|some|exactly one) +(\w+) +in +(\{[^}]*\}|[^\s,:]+(?: *, *[^\s,:]+(?! +in\b))*)"
    r"((?:(?!\bwhere\b|[:\n]).)*)(where[^:\n]*)?"
)
"""What copies and quantifiers begin with: its words, a parameter with its values, others, the conditions."""


def _header(text: str, random: Random) -> str:
    """Another list of values, another condition, or another parameter; often one that leaves no copy."""
    found = list(HEADER.finditer(text))
    if not found:
        return _snippet(text, random)
    match = random.choice(found)
    word, name, values, others, where = match.groups(default="")
    names = [name, random.choice(found)[2], "R"]
    first = values.strip("{}").split(",")[0]
    lists = (
        f"{values}, {first}", f"{{{first}, {first}}}", first, "{}", "3..1", "1..3", "0..b", "-1, 2", "{1, 01}",
        "ROBOTS", "{ROBOTS}", f"{{{name}}}", f"{first}, {{{name}}}", "1..1000000", "-3..-1", "a..b", f"{first},",
        "x, y", "no, yes",
    )  # fmt: skip
    one, other = random.choice((*names, first, "unheard", "1")), random.choice((*names, first, "unheard", "0"))
    sign = random.choice(("=", "!=", "<", ">=", "=="))
    tests = (
        f"{name} != {name}", f"{one} {sign} {other}", f"{one}+1 {sign} {other}", f"{one} {sign} {other}-1", "1 < 0",
        f"{name} != {name}, {one} {sign} {other}", f"{one} {sign} {other}, {name} != {name}", "1 > 0", "",
        f"{{{name}}} = {other}",
    )  # fmt: skip
    match random.randrange(5):
        case 0:
            values = random.choice(lists)
        case 1:
            name = random.choice((*names, "in", "action", "for", "N", "1"))
        case 2:
            others += f", {random.choice((*names, 'Z'))} in {random.choice(lists)} "
        case _:
            where = f"where {random.choice(tests)}"
    return f"{text[: match.start()]}{word} {name} in {values} {others} {where}{text[match.end() :]}"


def _never_made(text: str, random: Random) -> str:
    """A header that no combination satisfies, and another damage anywhere: also there, mistakes count."""
    found = [match for match in HEADER.finditer(text) if not match[5]]
    if found:
        match = random.choice(found)
        text = f"{text[: match.end()]} where {match[2]} != {match[2]} {text[match.end() :]}"
    return random.choice((_header, _header, _token, _put_in, _digits, _lines, _snippet))(text, random)


DAMAGES: tuple[Damage, ...] = (
    *(_header, _header, _header, _never_made, _never_made),
    *(_respaced, _respaced, _respaced, _older, _older, _older),
    *(_put_in, _in_comment, _in_comment, _other_space, _glued, _digits, _token, _token, _renamed, _renamed, _renamed),
    *(_lines, _block, _snippet, _predicate, _predicate),
)


def _encoded(text: str, random: Random) -> bytes:
    """As bytes: mostly plain UTF-8, sometimes with other line ends, marks, or in another encoding."""
    if random.random() < 0.8:
        return text.encode()
    ends = random.choice(("\r\n", "\r", "\n\r", "\u2028", "\x0b"))
    whole = text.encode()
    at = random.randrange(len(whole) + 1)
    forms = (
        text.replace("\n", ends).encode(), b"\xef\xbb\xbf" + whole, b"\xef\xbb\xbf" * 2 + whole,
        whole + b"\xef\xbb\xbf", text.encode("utf-16"), text.encode("utf-32"), whole[:at],
        ("// größer\n" + text).encode("latin-1", "replace"),
        whole[:at] + bytes([random.randrange(256)]) + whole[at + 1 :], whole + b"\0", whole + b"\x1a",
        b"// \xed\xa0\x80\n" + whole, b"// \xf4\x90\x80\x80\n" + whole, b"// \xc0\x80\n" + whole, whole + whole,
    )  # fmt: skip
    return random.choice(forms)


def _of_a_size(random: Random) -> str:
    """A text at one of the limits of the language, just below or just above."""
    around = random.choice((-2, -1, 0, 1, 2))
    kind, most = random.choice(SIZES)
    return kind(most + around)


def _rule(predicate: str, aliases: str = "", kind: str = "STATE RULES") -> str:
    variables = "BEGIN STATE VECTOR state S can be a, b END STATE VECTOR"
    return f"{variables} BEGIN ALIASES {aliases} END ALIASES BEGIN {kind} rule: {predicate} END {kind}"


def _goal(text: str) -> str:
    return _rule("true") + f" BEGIN GOALS goal type: priority {text} END GOALS"


def _lists(count: int, inside: str = "") -> str:
    start, end = "BEGIN GOALS goal type: constraint ", " END GOALS"
    return _rule("true") + " " + start * count + inside + end * count


def _chain(count: int, step: str) -> str:
    """Aliases of which each one is made of the one before."""
    chain = " ".join(f"define k{n} as {step.format(f'k{n - 1}')}" for n in range(1, count))
    return _rule(f"k{count - 1}", f"define k0 as S is a {chain}")


def _declared(count: int, what: str) -> str:
    match what:
        case "variables":
            return f"BEGIN STATE VECTOR {' '.join(f'state S{n} can be a' for n in range(count))} END STATE VECTOR"
        case "values":
            return f"BEGIN STATE VECTOR state S can be {', '.join(f'v{n}' for n in range(count))} END STATE VECTOR"
        case _:
            return _rule("true") + f" BEGIN ACTIONS {' '.join(f'action a{n}' for n in range(count))} END ACTIONS"


def _outcomes(count: int) -> str:
    """An alternative that denotes `count` assignments."""
    values = ", ".join(f"v{n}" for n in range(100))
    each = " OR ".join(f"(S is v{n // 100} AND T is v{n % 100})" for n in range(count % 1000))
    effect = each if count < 1000 else "(S is v0 OR NOT S is v0) AND (T is v0 OR NOT T is v0)"
    variables = f"state S can be {values} state T can be {values}" + (", more" if count > 10_000 else "")
    vector = f"BEGIN STATE VECTOR {variables} END STATE VECTOR"
    return f"{vector} BEGIN ACTIONS action go effects: none alternative effects: {effect} END ACTIONS"


SIZES: tuple[tuple[Callable[[int], str], int], ...] = (
    (lambda n: _rule("(" * n + "S is a" + ")" * n), 100),
    (lambda n: _rule("(" * n + "S is a" + ")" * (n - 1)), 50),
    (lambda n: _rule("NOT " * n + "S is a"), 99),
    (lambda n: _rule("NOT " * n + "S is a"), 100),
    (lambda n: _rule("(true AND " * n + "S is a" + ")" * n), 99),
    (lambda n: _rule("(S is b OR (true AND " * n + "S is a" + "))" * n), 49),
    (lambda n: _rule("(IF true THEN " * n + "S is a" + ")" * n), 99),
    (lambda n: _rule("(IF " * n + "S is a" + " THEN true)" * n), 49),
    (lambda n: _rule("(IF " * n + "S is a" + " THEN true)" * n), 99),
    (lambda n: _rule("(true IFONLYIF " * n + "S is a" + ")" * n, kind="REACTION RULES"), 99),
    (lambda n: _goal("goal: " + "NOT " * n + "S is a"), 97),
    (lambda n: _goal("goal: " + "NOT " * n + "S is a"), 98),
    (lambda n: _goal("when " + "NOT " * n + "S is a then goal: true"), 98),
    (_lists, 100),
    (lambda n: _lists(n, "goal: true"), 99),
    (lambda n: _lists(n, "goal: NOT true"), 98),
    (lambda n: _lists(n, "when S is a then goal: NOT true"), 97),
    (lambda n: _chain(n, "NOT {}"), 100),
    (lambda n: _chain(n, "(IF {} THEN true)"), 50),
    (lambda n: _chain(n, "(IF true THEN {})"), 100),
    (lambda n: _chain(n, "{}"), 1000),
    (lambda n: _chain(n, "{0} AND {0}"), 17),
    (lambda n: _declared(n, "variables"), 1000),
    (lambda n: _declared(n, "values"), 10_000),
    (lambda n: _declared(n, "actions"), 10_000),
    (_outcomes, 10_000),
    (_outcomes, 20),
    (lambda n: _rule("true") + " " * (n - len(_rule("true"))), 2_000_000),
    (lambda n: _rule("true") + "//" + "é" * ((n - len(_rule("true"))) // 2), 2_000_000),
    (lambda n: _rule("true") + f" BEGIN CONFIG max_plan_length: {n} END CONFIG", 1_000_000_000),
    (lambda n: _rule("true") + f" BEGIN CONFIG max_plan_length: {n} END CONFIG", 0),
    (lambda n: _rule("true") + f" BEGIN CONFIG max_plan_length: {'0' * n}1 END CONFIG", 17),
    (lambda n: _rule("true") + f" BEGIN ACTIONS action a duration: {n} END ACTIONS", 1_000_000_000),
    (lambda n: _rule("x" * n), 300),
)
