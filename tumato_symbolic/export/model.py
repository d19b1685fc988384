"""A closed loop with identifiers: what targets for model checkers print."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Sequence
from dataclasses import dataclass

from tumato_symbolic.export.closed_loop import ClosedLoop
from tumato_symbolic.export.decisions import DecisionRule, rules_of
from tumato_symbolic.export.identifiers import distinct, identifier
from tumato_symbolic.export.request import Request
from tumato_symbolic.spec import Connectives, Executing, Formula, Is, executing_atoms, fold


@dataclass(frozen=True, slots=True)
class Model:
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

    def printer(self, by: Connectives[str], equals: str, executing: Callable[[str], str]) -> Callable[[Formula], str]:
        """What prints formulas: `equals` stands between a variable and a value, `executing` says what an action is."""

        def atom(each: Is | Executing) -> str:
            if isinstance(each, Executing):
                return executing(self.actions[each.action])
            return f"({self.variables[each.variable]} {equals} {self.values[each.variable][each.value]})"

        return lambda formula: fold(formula, atom, by)


def infix(
    *, true: str, false: str, negation: str, conjunction: str, disjunction: str, equivalence: str
) -> Connectives[str]:
    """The connectives of a language that writes them between their operands."""

    def joined(parts: Sequence[str], by: str, none: str) -> str:
        return f"({f' {by} '.join(parts)})" if parts else none

    return Connectives(
        constant=lambda value: true if value else false,
        negation=lambda text: f"({negation}{text})",
        conjunction=lambda texts: joined(texts, conjunction, true),
        disjunction=lambda texts: joined(texts, disjunction, false),
        equivalence=lambda left, right: f"({left} {equivalence} {right})",
    )
