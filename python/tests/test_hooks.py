# SPDX-License-Identifier: MIT
"""Where to look next and whether to believe a claim, decided in Python."""

import math
from collections.abc import Sequence

import pytest
from conftest import SMALL

import crossnav


class Own(crossnav.Hooks):
    """The policy's answers, counted."""

    def __init__(self) -> None:
        super().__init__()
        self.options = 0
        self.claims: list[crossnav.Claim] = []

    def score_exploration(self, goal: str, agent: crossnav.AgentPose,
                          options: Sequence[crossnav.ExplorationOption]) -> Sequence[float]:
        assert goal and all(o.path_m >= 0 and o.kind for o in options)
        self.options = max(self.options, len(options))
        return [o.score_m for o in options]

    def judge_claim(self, goal: str, claim: crossnav.Claim,
                    observation: crossnav.Observation) -> crossnav.ClaimVerdict:
        assert observation.depth_m.shape == (160, 160)
        self.claims.append(claim)
        return super().judge_claim(goal, claim, observation)


def actions(simulator: crossnav.Simulator, start: crossnav.AgentPose,
            hooks: crossnav.Hooks | None, goal: str = "sofa", steps: int = 60
            ) -> list[crossnav.Action]:
    simulator.reset(start)
    agent = crossnav.Agent(simulator.ground_truth(), SMALL, hooks=hooks)
    agent.set_goal(goal)
    done: list[crossnav.Action] = []
    while len(done) < steps and crossnav.Action.STOP not in done:
        result = agent.step(simulator.observe(with_colour=False))
        if result.all_explored:
            break
        done.append(result.action)
        simulator.step(result.action)
    return done


def test_own_answers_change_nothing(simulator: crossnav.Simulator,
                                    episode: crossnav.Episode) -> None:
    hooks = Own()
    for goal in ("sofa", "toilet"):
        without = actions(simulator, episode.start, None, goal)
        assert actions(simulator, episode.start, hooks, goal) == without
        assert actions(simulator, episode.start, crossnav.Hooks(), goal) == without
    assert hooks.options > 0
    assert hooks.claims[-1].verdict == crossnav.ClaimVerdict.AGREED
    assert hooks.claims[-1].failed_check == "" and hooks.claims[-1].distance_m > 0


def test_a_refuted_claim_never_ends_in_stop(simulator: crossnav.Simulator,
                                            episode: crossnav.Episode) -> None:
    class Never(crossnav.Hooks):
        def judge_claim(self, goal: str, claim: crossnav.Claim,
                        observation: crossnav.Observation) -> crossnav.ClaimVerdict:
            return crossnav.ClaimVerdict.REFUTED

    assert crossnav.Action.STOP not in actions(simulator, episode.start, Never())


def test_infinity_is_never(simulator: crossnav.Simulator, episode: crossnav.Episode) -> None:
    class Home(crossnav.Hooks):
        def score_exploration(self, goal: str, agent: crossnav.AgentPose,
                              options: Sequence[crossnav.ExplorationOption]) -> list[float]:
            return [math.inf for _ in options]

    simulator.reset(episode.start)
    agent = crossnav.Agent(simulator.ground_truth(), SMALL, hooks=Home())
    agent.set_goal("toilet")
    for _ in range(80):
        result = agent.step(simulator.observe(with_colour=False))
        assert not any(c["is_target"] and "frontier" in c["kind"]
                       for c in result.trace["candidates"])
        if result.all_explored:
            break
        simulator.step(result.action)


@pytest.mark.parametrize(("answer", "message"), [
    ([], "one score for each option"), ("no", "numbers"), ([math.nan], "not a number")])
def test_bad_scores_are_named(simulator: crossnav.Simulator, episode: crossnav.Episode,
                              answer: object, message: str) -> None:
    class Bad(crossnav.Hooks):
        def score_exploration(self, goal: str, agent: crossnav.AgentPose,
                              options: Sequence[crossnav.ExplorationOption]) -> Sequence[float]:
            if isinstance(answer, list) and answer:
                return answer * len(options)
            return answer  # type: ignore[return-value]

    with pytest.raises(crossnav.Error, match=message) as caught:
        actions(simulator, episode.start, Bad(), "toilet")
    assert caught.value.where == "Hooks.score_exploration"


def test_an_exception_comes_out_as_it_is(simulator: crossnav.Simulator,
                                         episode: crossnav.Episode) -> None:
    class Breaks(crossnav.Hooks):
        def score_exploration(self, goal: str, agent: crossnav.AgentPose,
                              options: Sequence[crossnav.ExplorationOption]) -> Sequence[float]:
            raise ZeroDivisionError("mine")

    with pytest.raises(ZeroDivisionError, match="mine"):
        actions(simulator, episode.start, Breaks(), "toilet")


def test_the_literal_method_asks_no_hooks(simulator: crossnav.Simulator) -> None:
    with pytest.raises(crossnav.Error, match="policy.profile"):
        crossnav.Agent(simulator.ground_truth(), {**SMALL, "policy.profile": "paper"},
                       hooks=crossnav.Hooks())
