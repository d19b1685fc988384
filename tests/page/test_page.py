"""What a page carries, and how it is put together."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import pytest

from tests.page.judged import NODE, needs_node
from tests.page.pages import carried
from tests.repo.documents import ROOT
from tumato_symbolic import Realizable, parse, synthesize
from tumato_symbolic.diagnostics import Source
from tumato_symbolic.policy import Policy, RuleList, as_table, bind, minimal_rules
from tumato_symbolic.report.html.contents import NoPolicyPage, PolicyPage
from tumato_symbolic.report.html.page import MODULES, bundle, page
from tumato_symbolic.report.html.record import policy_record, spec_record
from tumato_symbolic.semantics import all_states
from tumato_symbolic.syntax import read_source

SOURCES = ROOT / "tumato_symbolic" / "report" / "html"
KINDS = (PolicyPage, NoPolicyPage)

WRITTEN = """
BEGIN STATE VECTOR
state S_Tank can be 0..3
state S_Valve can be open, closed
END STATE VECTOR
BEGIN RESOURCES
resource PUMP
END RESOURCES
BEGIN ACTIONS
action fill
  duration: 2
  controlled resources: PUMP
  preconditions: S_Valve is closed
  nominal effects: none
    when S_Tank < 3: S_Tank is S_Tank + 1
  alternative effects: none
for V in open, closed
  action set_{V}
    nominal effects: S_Valve is {V}
end for
END ACTIONS
BEGIN REACTION RULES
rule: IF S_Tank is 0 THEN NOT executing set_open
END REACTION RULES
BEGIN STATE RULES
severity: 2
rule: S_Tank < 3 IFONLYIF S_Tank in {0, 1, 2}
END STATE RULES
BEGIN GOALS
goal type: priority
when S_Valve is open then goal: executing set_closed
goal: S_Tank >= 2
END GOALS
"""


def page_of(path: str, text: str) -> str:
    """The page of a specification's policy, without a proof."""
    outcome = synthesize(parse(text))
    assert isinstance(outcome, Realizable)
    return page(PolicyPage(Source(path, text), parse(text), "p.json", outcome.policy, "any", None, "none"))


def test_a_specification_as_data() -> None:
    """Actions with their cases, predicates in numbers, copies with their parameters."""
    spec = parse(WRITTEN)
    record = spec_record(spec, Source("tank.tum", WRITTEN), spec.ordering)
    assert record["variables"] == [["S_Tank", ["0", "1", "2", "3"]], ["S_Valve", ["open", "closed"]]]
    fill, set_open, set_closed = record["actions"]
    assert (fill["name"], fill["duration"], fill["resources"]) == ("fill", 2, [0])
    assert [rule["is"] for rule in fill["pre"]] == [[1, 1]]
    assert sorted(case["effects"] for case in fill["cases"]) == [[], [[0, 1], []], [[0, 2], []], [[0, 3], []]]
    assert [set_open["with"], set_closed["with"]] == ["V = open", "V = closed"]
    assert record["reaction_rules"][0]["is"] == ["|", ["!", [0, 0]], ["!", ["x", 1]]]
    assert record["state_rules"][0]["severity"] == 2
    assert [body["is"] for body in record["bodies"]] == [["x", 2], [0, 2, 3]]
    assert record["goals"]["members"][0]["when"]["is"] == [1, 0]


def test_each_goal_is_written_as_in_its_line() -> None:
    """Also where another of the same meaning, written otherwise, stands before it."""
    full = "goal: S_Tank >= 2"
    text = WRITTEN.replace(full, f"when S_Valve is closed then {full}\ngoal: S_Tank is 2 OR S_Tank is 3")
    record = spec_record(parse(text), Source("tank.tum", text), "any")
    *_, before, last = record["goals"]["members"]
    assert before["then"]["body"] == last["body"]
    for goal in (before["then"], last):
        assert text.splitlines()[goal["line"] - 1].endswith(f"goal: {goal['text']}")


@pytest.mark.parametrize("policy_format", ["table", "diagram"])
def test_a_policy_as_data(policy_format: str) -> None:
    """The diagram says of every state what the policy says."""
    spec = parse((ROOT / "examples" / "lid.tum").read_text(encoding="utf-8"))
    outcome = synthesize(spec, policy_format=policy_format)  # type: ignore[arg-type]
    assert isinstance(outcome, Realizable)
    record, table = policy_record(outcome.policy, "lid.json"), as_table(bind(outcome.policy, spec), 10_000)
    assert table is not None

    def follow(root: int, state: tuple[int, ...]) -> bool:
        while root > 1:
            level, below = record["nodes"][root - 2]
            root = below[state[record["order"][level]]]
        return root == 1

    for state in all_states(spec):
        decided = {number for number, root in enumerate(record["roots"]) if follow(root, state)}
        assert (decided if follow(record["defined"], state) else None) == table.rows.get(state)


def test_names_and_comments_end_no_element() -> None:
    """Whatever a file is called and whatever its comments say, it stays text."""
    evil = "</script><script>alert(1)</script><!-- & {{program}} \\u2028"
    text = f"// {evil}\n{WRITTEN}"
    made = page_of(f"{evil}.tum", text)
    assert made.count("<script") == made.count("</script>") == 2
    assert "alert(1)<" not in made
    data = carried(made)
    assert data["spec"]["text"] == text
    assert data["spec"]["file"] == f"{evil}.tum"


def test_a_page_asks_nothing_of_others() -> None:
    """It says so to the browser, and the only address in it is a name."""
    made = page_of("tank.tum", WRITTEN)
    assert "default-src 'none'" in made
    addresses = set(re.findall(r"[a-z]+://[^\"'` )]*", made))
    assert addresses == {"http://www.w3.org/2000/svg"}


def test_pages_are_small() -> None:
    """The page of the paper's robot with its rules."""
    source = read_source(str(ROOT / "examples" / "amr.tum"))
    policy, spec = Policy.load(str(ROOT / "proofs" / "amr.policy.json")), parse(source.text)
    made = page(PolicyPage(source, spec, "amr.json", policy, "any", None, RuleList(minimal_rules(policy))))
    assert len(made) < 80_000


@pytest.mark.parametrize("kind", KINDS)
def test_modules_import_what_stands_before_them(kind: type[PolicyPage | NoPolicyPage]) -> None:
    """The names of all modules of a page share one scope, in which each name is made once, and every import is one."""
    made: dict[str, str] = {}
    for module in MODULES[kind]:
        text = (SOURCES / f"{module}.mjs").read_text(encoding="utf-8")
        for names, source in re.findall(r'^import \{ ([^}]*) \} from "\./(\w+)\.mjs";$', text, re.MULTILINE):
            for name in names.split(", "):
                assert made.get(name) == source, (module, name)
        for name in re.findall(r"^(?:export )?(?:async )?(?:function\*?|const|let|class) (\w+)", text, re.MULTILINE):
            assert made.setdefault(name, module) == module, (module, name)


def test_every_module_belongs_to_a_page() -> None:
    """What lies in the folder is used."""
    assert {path.stem for path in SOURCES.glob("*.mjs")} == {module for kind in KINDS for module in MODULES[kind]}


def test_no_template_stands_in_another() -> None:
    """Spaces are left out around strings and templates, which are told apart without reading what is in them."""
    for path in SOURCES.glob("*.mjs"):
        for template in re.findall(r"`[^`]*`", path.read_text(encoding="utf-8")):
            assert template.count("${") <= template.count("}"), (path.name, template)


@needs_node
@pytest.mark.parametrize("kind", KINDS)
def test_the_program_of_a_page_can_be_read(kind: type[PolicyPage | NoPolicyPage], tmp_path: Path) -> None:
    """By node, as one module, in which nothing is left of imports."""
    program = bundle(kind)
    assert not re.search(r"^(import|export) ", program, re.MULTILINE)
    (tmp_path / "page.mjs").write_text(program, encoding="utf-8")
    ran = subprocess.run([str(NODE), "--check", "page.mjs"], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert ran.returncode == 0, ran.stderr
