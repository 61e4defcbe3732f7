# SPDX-License-Identifier: MIT
"""How often frames of the training houses are drawn: rare goals, drawn homes and false claims more often."""

import common
import numpy as np

DRAWN = 4.0  # chosen: two homes among seven hundred houses are a seventh of what is drawn
LOOKALIKE = 2.0  # chosen: an armchair is told from a sofa by its width alone, if both are of one series
HARD = 3.0  # chosen: a frame with a sure false claim is drawn four times as often as one without
UNSEEN = 0.3  # chosen: score of the false claims of frames not yet drawn


def frame_weights(houses):
    """Frames with goals that few frames show are drawn more often, and frames of homes that people drew or of seats
    that look like another goal; frames without goals less. Also which frame shows which goal, stairs last."""
    places, goals, alike = [], [], []
    for house in houses:
        for index in range(len(house.frames)):
            seen = np.zeros(len(common.GOALS) + 1)
            ids, count = np.unique(house.instance[index][::4, ::4], return_counts=True)
            big = ids[count > 20]  # half a percent of the picture
            for goal in house.goal_of[big]:
                seen[goal] = seen[goal] or goal >= 0
            seen[-1] = house.is_stairs[big].any()
            alike.append(house.is_lookalike[big].any())
            places.append((house, index))
            goals.append(seen)
    goals = np.array(goals)
    rarity = 1 / np.maximum(goals.mean(0), 0.01) ** 0.5
    weights = 1.0 + (goals * rarity).max(1)
    weights *= [DRAWN if house.name in common.LOOKED_AT else 1.0 for house, _ in places]
    weights *= np.where(alike, LOOKALIKE, 1.0)
    return places, weights / weights.sum(), goals


class Draw:
    """Frames of the training houses, of which the hard ones come more often."""

    def __init__(self, places, weights, before=None):
        """`before`: the draw of fewer houses, whose scores are kept."""
        self.places, self.weights = places, weights
        known = before.scores() if before else {}
        self.false = np.array([known.get((house.name, index), UNSEEN) for house, index in places])

    def scores(self):
        return {(house.name, index): score for (house, index), score in zip(self.places, self.false, strict=True)}

    def choose(self, batch, rng):
        chance = self.weights * (1 + HARD * self.false)
        return rng.choice(len(self.places), batch, p=chance / chance.sum())

    def learn(self, chosen, false):
        """Scores of the highest false claims of the chosen frames."""
        self.false[chosen] = 0.5 * (self.false[chosen] + false)
