"""What targets for model checkers share: a closed loop with identifiers, and what is claimed of it (`Claims`)."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Sequence

from msgspec import Struct

from tumato_symbolic.export.closed_loop import ClosedLoop, lasting, preconditions
from tumato_symbolic.export.decisions import DecisionRule, rules_of
from tumato_symbolic.export.identifiers import distinct, identifier
from tumato_symbolic.export.request import Request
from tumato_symbolic.spec import TRUE, Connectives, Executing, Formula, Is, executing_atoms, fold


class Model(Struct, frozen=True):
    """A closed loop, the decisions in it as a list of rules, and the identifiers of a language.

    `actions` are those of the entries of `loop.actions`. `rules` are numbered from 0.
    """

    loop: ClosedLoop
    rules: tuple[DecisionRule, ...]
    variables: tuple[str, ...]
    values: tuple[tuple[str, ...], ...]
    actions: tuple[str, ...]

    @classmethod
    def of(cls, request: Request, reserved: Collection[str], ours: tuple[str, ...]) -> Model:
        """The model of a policy; raises `UserError` (TUM508) where it has no short list of rules.

        No identifier is `reserved`, or begins like one of `ours`.
        """
        loop = ClosedLoop.of(request)
        wanted: dict[tuple[str | int, ...], str] = {}
        for variable in loop.variables:
            wanted["variable", variable.name] = identifier(variable.name)
            for value in variable.values:
                wanted["value", variable.name, value] = identifier(f"{variable.name}_{value}")
        for number, action in enumerate(loop.actions):
            wanted["action", action.name, number] = identifier(action.name)
        apart = {key: f"x_{name}" if name.startswith(ours) else name for key, name in wanted.items()}
        found = distinct(apart, reserved)
        return cls(
            loop,
            rules_of(request.policy),
            tuple(found["variable", each.name] for each in loop.variables),
            tuple(tuple(found["value", each.name, value] for value in each.values) for each in loop.variables),
            tuple(found["action", action.name, number] for number, action in enumerate(loop.actions)),
        )

    @property
    def undecided(self) -> list[int]:
        """The numbers of the rules by which nothing is decided."""
        return [number for number, rule in enumerate(self.rules) if rule.actions is None]

    @property
    def named_by_goals(self) -> list[int]:
        """The entries of the actions of which goals say that they are executed first."""
        return sorted({action for goal in self.loop.goals for action in executing_atoms(goal.body)})

    @property
    def effects(self) -> list[tuple[int, tuple[tuple[int, int], ...]]]:
        """Every effect, with the entry of its action."""
        return [(number, effect) for number, action in enumerate(self.loop.actions) for effect in action.effects]

    def rules_with(self, entry: int) -> list[int]:
        """The numbers of the rules by which the action of an entry is executed."""
        name = self.loop.actions[entry].name
        return [number for number, rule in enumerate(self.rules) if name in (rule.actions or ())]

    def has_cases(self, entry: int) -> bool:
        """Whether the action of an entry has others, of which the preconditions choose one."""
        return all(cases != (entry,) for cases in self.loop.cases)

    def condition(self, rule: DecisionRule) -> Iterator[tuple[int, list[int]]]:
        """Where a rule matches: numbers of variables, and those of the values that they may have."""
        numbers = {variable.name: number for number, variable in enumerate(self.loop.variables)}
        for name, values in rule.condition:
            variable = numbers[name]
            known = self.loop.variables[variable].values
            yield variable, [known.index(value) for value in values]


class Language(Struct, frozen=True):
    """How a language writes formulas: connectives, what is between a variable and a value, which rules decide.

    `and_below` joins conditions that stand below each other; `safe`, `valid` and `decided` name the safe, the valid and
    the decided states.
    """

    by: Connectives[str]
    equals: str
    rule_is: Callable[[Sequence[int]], str]
    and_below: str
    safe: str
    valid: str = "valid"
    decided: str = "decided"


class Claims:
    """What is claimed of a model, in a language that knows `executed_NAME`, `waiting_NAME` and so on."""

    def __init__(self, model: Model, language: Language) -> None:
        self.model, self.language = model, language
        self.kept = [number for number, each in enumerate(model.loop.required) if each.when != TRUE]
        """The required rules of which it depends on the state of the decision whether they are."""

    def now(self, formula: Formula) -> str:
        """A formula in the state of now."""
        return self._printed(formula, "executed")

    def all(self, parts: Iterable[str]) -> str:
        """All of some conditions."""
        return self.language.by.conjunction(list(parts))

    def any(self, parts: Iterable[str]) -> str:
        """Some of some conditions."""
        return self.language.by.disjunction(list(parts))

    def matches(self, rule: DecisionRule) -> str:
        """Where a rule decides, if no earlier one does."""
        parts = self.model.condition(rule)
        return self.all(self.any(self._is(variable, value) for value in values) for variable, values in parts)

    def placeholders(self) -> dict[str, str]:
        """What every template has a place for: the claims by the names of these places."""
        by, loop, model = self.language.by, self.model.loop, self.model
        decided = by.negation(self.language.rule_is(model.undecided)) if model.undecided else by.constant(True)
        listed = {
            "allowed": self.allowed(),
            "required": self.required(),
            "possible": self.possible(),
            "met": self.met(self.language.safe),
        }
        below = {name: self._below(parts) for name, parts in listed.items()}
        states = {"valid": self.now(loop.valid), "safe": self.now(loop.safe)}
        runs = {"begins": self.begins(), "complete": self.complete()}
        return {"decided": decided, "quiet": self.quiet(), **states, **below, **runs}

    def _below(self, parts: Iterable[str]) -> str:
        """Conditions below each other, without those that always hold."""
        true = self.language.by.constant(True)
        return self.language.and_below.join(part for part in parts if part != true) or true

    def begins(self) -> str:
        """Where runs begin: in the valid states; with starts, in these, and in all other decided states."""
        starts = self.model.loop.starts
        if starts is None:
            return self.language.valid
        return self.any([self.all([self.language.valid, self.now(starts)]), self.language.decided])

    def complete(self) -> str:
        """What holds where runs begin: the state is decided; with starts, it is valid too."""
        names = [self.language.decided, *([] if self.model.loop.starts is None else [self.language.valid])]
        return self.all(names)

    def executed(self, entry: int) -> str:
        """Where an entry of the actions is executed."""
        decided = self.decides(entry)
        if self.model.rules_with(entry) and self.model.has_cases(entry):
            return self.all([decided, self.now(preconditions(self.model.loop.actions[entry]))])
        return decided

    def decides(self, entry: int) -> str:
        """Where the policy decides the action of an entry."""
        rules = self.model.rules_with(entry)
        return self.language.rule_is(rules) if rules else self.language.by.constant(False)

    def quiet(self) -> str:
        """Where nothing that is executed has effects."""
        entries = zip(self.model.actions, self.model.loop.actions, strict=True)
        return self.language.by.negation(self.any(f"executed_{name}" for name, each in entries if each.effects))

    def allowed(self) -> list[str]:
        """What holds of a decision before any effect: preconditions, what excludes each other, reaction rules."""
        loop, model, found = self.model.loop, self.model, []
        for cases in loop.cases:
            if model.rules_with(cases[0]):
                possible = self.any(self.now(preconditions(loop.actions[case])) for case in cases)
                found.append(self.implied(self.decides(cases[0]), possible))
        for first, second in loop.excluded:
            both = self.all([f"executed_{model.actions[first]}", f"executed_{model.actions[second]}"])
            found.append(self.language.by.negation(both))
        return [*found, self.now(loop.reaction_rules)]

    def required(self) -> list[str]:
        """What holds after each effect; with starts, that the next decision is there, too."""
        rules = [self.now(each.rule) for each in self.model.loop.required]
        kept = [
            self.implied(f"kept_{number}", rule) if number in self.kept else rule for number, rule in enumerate(rules)
        ]
        return kept if self.model.loop.starts is None else [*kept, self.language.decided]

    def possible(self) -> list[str]:
        """The preconditions of what has not taken effect, where they have to hold until then."""
        if not self.model.loop.preconditions_last:
            return []
        entries = zip(self.model.actions, self.model.loop.actions, strict=True)
        return [self.implied(f"waiting_{name}", self.now(lasting(action))) for name, action in entries]

    def met(self, safe: str) -> list[str]:
        """What holds where the goals of a run are reached; `safe` is the name for safe states."""
        goals = [
            self.implied(f"active_{number}", self._printed(goal.body, "first"))
            for number, goal in enumerate(self.model.loop.goals)
        ]
        return [*goals, safe] if self.model.loop.several_steps else goals

    def has_goals(self) -> bool:
        """Whether a nominal run has anything to reach."""
        return bool(self.model.loop.goals) or self.model.loop.several_steps

    def same(self, one: str, other: str) -> str:
        """Where both of two conditions hold, or none."""
        return self.language.by.equivalence(one, other)

    def implied(self, condition: str, then: str) -> str:
        """A condition and what follows from it."""
        return self.language.by.disjunction([self.language.by.negation(condition), then])

    def _printed(self, formula: Formula, executing: str) -> str:
        def atom(each: Is | Executing) -> str:
            if isinstance(each, Executing):
                return f"{executing}_{self.model.actions[each.action]}"
            return self._is(each.variable, each.value)

        return fold(formula, atom, self.language.by)

    def _is(self, variable: int, value: int) -> str:
        return f"({self.model.variables[variable]} {self.language.equals} {self.model.values[variable][value]})"


def infix(
    *, true: str, false: str, negation: str, conjunction: str, disjunction: str, equivalence: str
) -> Connectives[str]:
    """The connectives of a language that writes them between their operands; constants stand only by themselves."""
    opposites = {true: false, false: true}

    def negated(text: str) -> str:
        return opposites.get(text, f"({negation}{text})")

    def joined(texts: Sequence[str], by: str, neutral: str) -> str:
        parts = [text for text in texts if text != neutral]
        if opposites[neutral] in parts:
            return opposites[neutral]
        return f"({f' {by} '.join(parts)})" if len(parts) > 1 else "".join(parts) or neutral

    def equivalent(left: str, right: str) -> str:
        for one, other in ((left, right), (right, left)):
            if one in opposites:
                return other if one == true else negated(other)
        return f"({left} {equivalence} {right})"

    return Connectives(
        constant=lambda value: true if value else false,
        negation=negated,
        conjunction=lambda texts: joined(texts, conjunction, true),
        disjunction=lambda texts: joined(texts, disjunction, false),
        equivalence=equivalent,
    )
