"""Specifications as a user would type them."""

from __future__ import annotations

from collections.abc import Sequence

from msgspec import Struct, field


class Text(Struct):
    """The parts of a specification, in the order in which they were added."""

    states: list[str] = field(default_factory=list)
    aliases: list[str] = field(default_factory=list)
    resources: list[str] = field(default_factory=list)
    actions: list[str] = field(default_factory=list)
    reaction_rules: list[str] = field(default_factory=list)
    state_rules: list[str] = field(default_factory=list)
    assumptions: list[str] = field(default_factory=list)
    goals: list[str] = field(default_factory=list)
    starts: list[str] = field(default_factory=list)
    longest_plan: int | None = None
    goal_type: str = "priority"

    def state(self, name: str, *values: str) -> None:
        """A state variable."""
        self.states.append(f"state {name} can be {', '.join(values)}")

    def alias(self, name: str, predicate: str) -> None:
        """A name for a predicate."""
        self.aliases.append(f"define {name} as {predicate}")

    def resource(self, *names: str) -> None:
        """Resources that actions control."""
        self.resources += [f"resource {name}" for name in names]

    def action(
        self,
        name: str,
        effects: str,
        *alternatives: str,
        when: str = "none",
        holds: Sequence[str] = (),
        takes: int = 1,
    ) -> None:
        """An action: its nominal and alternative effects, preconditions, resources and duration."""
        lines = [f"action {name}", f"duration: {takes}"]
        if holds:
            lines.append(f"controlled resources: {', '.join(holds)}")
        lines += [f"preconditions: {when}", f"nominal effects: {effects}"]
        lines += [f"alternative effects: {alternative}" for alternative in alternatives]
        self.actions.append("\n".join(lines))

    def rule(self, predicate: str) -> None:
        """What safe states satisfy."""
        self.state_rules.append(f"rule: {predicate}")

    def react(self, predicate: str) -> None:
        """What states and executed actions satisfy."""
        self.reaction_rules.append(f"rule: {predicate}")

    def assume(self, predicate: str) -> None:
        """What valid states satisfy."""
        self.assumptions.append(f"assume: {predicate}")

    def goal(self, body: str, when: str | None = None) -> None:
        """The next goal of the one list."""
        self.goals.append(f"when {when} then goal: {body}" if when else f"goal: {body}")

    def start(self, predicate: str) -> None:
        """Where the robot may begin."""
        self.starts.append(f"start: {predicate}")

    def render(self) -> str:
        """The whole text; empty blocks are left out."""
        goals = [f"goal type: {self.goal_type}", *self.goals] if self.goals else []
        config = [] if self.longest_plan is None else [f"max_plan_length: {self.longest_plan}"]
        blocks = {
            "STATE VECTOR": self.states,
            "ALIASES": self.aliases,
            "RESOURCES": self.resources,
            "ACTIONS": self.actions,
            "REACTION RULES": self.reaction_rules,
            "STATE RULES": self.state_rules,
            "ASSUMPTIONS": self.assumptions,
            "GOALS": goals,
            "START": self.starts,
            "CONFIG": config,
        }
        parts = [f"BEGIN {title}\n" + "\n".join(lines) + f"\nEND {title}\n" for title, lines in blocks.items() if lines]
        return "\n".join(parts)


def all_of(predicates: Sequence[str]) -> str:
    """The conjunction of predicates that need no parentheses."""
    return " AND ".join(predicates)
