"""When something is due, and the way from one meeting of replicas to the next."""

from hypothesis import given
from hypothesis import strategies as st

from mesokit import Box, Case, Conservation, Run, Stress, Trajectory
from mesokit.run.schedule import Leg, Schedule


def schedule(steps=100, warmup=7, every=(5, 6), frames=20, checkpoint=None):
    return Schedule(
        Case(
            run=Run(steps, warmup=warmup, checkpoint_every=checkpoint),
            box=Box([8, 8]),
            observe=[Conservation(every=every[0]), Stress(every=every[1])],
            trajectory=Trajectory(every=frames),
        )
    )


def test_replicas_meet_for_frames_and_checkpoints_but_not_for_samples():
    found = schedule(checkpoint=31)
    meetings, step = [], 0
    while step < found.last_step:
        step = found.next_meeting(step)
        meetings.append(step)
    assert meetings == [7, 27, 31, 47, 62, 67, 87, 93, 107]
    assert found.legs(7, 17) == [
        Leg(5, frozenset(), False, ("conservation",)),
        Leg(1, frozenset({"stress"}), False, ("stress",)),
        Leg(4, frozenset(), False, ("conservation",)),
    ]
    assert found.legs(5, 7) == [Leg(2, frozenset(), True, ("conservation",))]


@given(st.data())
def test_no_sample_is_lost_or_taken_twice_wherever_calls_end(data):
    found = schedule(every=(data.draw(st.integers(1, 9)), data.draw(st.integers(1, 9))))
    step, samples, done = 0, [], 0
    while step < found.last_step:
        end = data.draw(st.integers(step + 1, found.next_meeting(step)))
        for leg in found.legs(step, end):
            done += leg.steps
            assert ("stress" in leg.measure) == ("stress" in leg.samples)
            samples += [(done, name) for name in leg.samples]
        step = end
    assert done == found.last_step
    due = [(at, o.label) for at in range(1, found.last_step + 1) for o in found.due(at)]
    assert samples == due
