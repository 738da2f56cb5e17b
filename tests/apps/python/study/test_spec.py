# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""What a study's spec says."""
import pytest
from viewgain.study import SpecError, read_spec

SPEC = """objects = ["cube.off", "more/ball.off"]
policies = ["gain:combined", "frontier", "gain:rear_side_voxel"]
against = "frontier"
seeds = [3, 1]
sensors = ["sr4000", "tof.toml"]
voxels = [0.01, 0.005]
max_views = 5
flags = ["--up=y"]
"""


def spec_of(text, name="spec.toml"):
    with open(name, "w", encoding="utf-8") as file:
        file.write(text)
    return read_spec(name, "1")


def changed(old, new):
    assert old in SPEC
    return SPEC.replace(old, new, 1)


def test_lists_are_crossed(folder):
    spec = spec_of(SPEC)
    assert len(spec.runs) == 2 * 3 * 2 * 2 * 2 == len({run.hash for run in spec.runs})
    assert spec.against == "frontier" and spec.objects[1].mesh == folder / "more/ball.off"
    assert spec.title(spec.runs[2]) == "cube, gain:rear_side_voxel, seed 3, sr4000, voxel 0.01"
    assert spec.words(spec.runs[2]) == [
        "--sensor=sr4000", "--voxel=0.01", "--seed=3", "--max-views=5", "--tolerance=0.01", "--pictures=off", "--quiet", "--policy=gain",
        "--gain=rear_side_voxel", "--up=y", "--stop=gain=0,area=0,idle=0,promises=0", "--", str(folder / "cube.off")]


def test_objects_have_flags_and_surroundings_of_their_own(folder):
    (folder / "reach.toml").write_text("poses = \"poses.txt\"\n")
    (folder / "poses.txt").write_text("1")
    text = changed('"more/ball.off"', '{mesh = "more/ball.off", name = "b", reach = "reach.toml", obstacles = ["cube.off", "0,0,0,1,1,1"], '
                                      'flags = ["--stop=coverage=0.9", "--count=7"]}')
    run = spec_of(text).runs[6]
    assert spec_of(text).title(run).startswith("b, ")
    words = spec_of(text).words(run)
    for word in (f"--reach={folder}/reach.toml", f"--obstacle={folder}/cube.off", "--obstacle=0,0,0,1,1,1", "--count=7",
                 "--stop=gain=0,area=0,idle=0,promises=0,coverage=0.9"):
        assert words.count(word) == 1, word
    before = run.hash
    (folder / "poses.txt").write_text("2")  # a file that a file names
    assert spec_of(text).runs[6].hash != before
    assert "--count=7" not in spec_of(text).words(spec_of(text).runs[0])


def test_policies_are_words_or_programs(folder):
    (folder / "mine.py").write_text("1")
    text = changed('"frontier", ', '"frontier", "tour:5:2", {name = "mine", command = "python3 mine.py --fast"}, ')
    spec = spec_of(text)
    assert [policy.name for policy in spec.policies] == ["gain:combined", "frontier", "tour:5:2", "mine", "gain:rear_side_voxel"]
    assert spec.policies[2].words == ("--policy=gain", "--plan=5,2")
    assert spec.policies[3].command == ("python3", str(folder / "mine.py"), "--fast") and spec.policies[3].words == ()
    before = spec.runs[3].hash
    (folder / "mine.py").write_text("2")
    assert spec_of(text).runs[3].hash != before


def test_coverage_is_not_counted_finer_than_voxels(folder):
    assert spec_of(SPEC).tolerance == 0.01  # the largest voxel
    assert spec_of(changed("[0.01, 0.005]", "[0.002]")).tolerance == 0.005
    assert spec_of(changed("max_views", "tolerance = 0.003\nmax_views")).tolerance == 0.003


def test_hashes_follow_what_can_change_a_result(folder):
    before = spec_of(SPEC).runs[-1].hash  # ball, tof.toml, 0.005, seed 1
    cases = 0
    for old, new in (("max_views = 5", "max_views = 6"), ("max_views", "tolerance = 0.02\nmax_views"),
                     ("max_views", "kept_candidates = 5\nmax_views"), ("--up=y", "--up=x")):
        assert spec_of(changed(old, new)).runs[-1].hash != before, new
        cases += 1
    for name in ("more/ball.off", "tof.toml"):
        contents = (folder / name).read_text()
        (folder / name).write_text("changed\n")
        assert spec_of(SPEC).runs[-1].hash != before, name
        (folder / name).write_text(contents)
        cases += 1
    assert cases == 6 and read_spec("spec.toml", "2").runs[-1].hash != before
    # Neither what it stands beside nor where the files lie.
    assert spec_of(changed("seeds = [3, 1]", "seeds = [1]")).runs[-1].hash == before
    assert spec_of(changed('["cube.off", ', "[")).runs[-1].hash == before
    (folder / "else").mkdir()
    for name in ("cube.off", "more/ball.off", "tof.toml"):
        target = folder / "else" / name
        target.parent.mkdir(exist_ok=True)
        target.write_text((folder / name).read_text())
    assert spec_of(SPEC, "else/spec.toml").runs[-1].hash == before


@pytest.mark.parametrize("old, new, words", [
    ("seeds = [3, 1]\n", "", ["seeds is missing"]),
    ("seeds = [3, 1]", "seeds = []", ["line 4", "seeds", "not empty"]),
    ("seeds = [3, 1]", "seeds = [1, 1]", ["line 4", "twice"]),
    ("seeds = [3, 1]", "seeds = [-1]", ["line 4", "-1"]),
    ("seeds = [3, 1]", "seeds = [true]", ["line 4", "True"]),
    ("seeds = [3, 1]", "seeds = 3", ["line 4", "list"]),
    ("seeds = [3, 1]", "seeds = [3", ["spec.toml", "line 5"]),
    ("more/ball.off", "ball.off", ["line 1", "ball.off", "no file"]),
    ("more/ball.off", "./cube.off", ["line 1", "two objects", "cube"]),
    ('"more/ball.off"', '{mesh = "more/ball.off", reech = "x"}', ["line 1", "reech", "reach"]),
    ('"more/ball.off"', '{mesh = "more/ball.off", reach = "x.toml"}', ["line 1", "x.toml"]),
    ('"more/ball.off"', '{mesh = "more/ball.off", obstacles = "x"}', ["line 1", "obstacles must be a list"]),
    ('"more/ball.off"', '{mesh = "more/ball.off", flags = ["--seed=1"]}', ["line 1", "--seed"]),
    ('"more/ball.off"', '{mesh = "more/ball.off", name = "a|b"}', ["line 1", "a table cannot show"]),
    ('"frontier", ', '"gain", ', ["line 2", "'gain'", "gain:NAME"]),
    ('"frontier", ', '"frontier:x", ', ["line 2", "frontier:x"]),
    ('"frontier", ', '{name = "mine"}, ', ["line 2", "command"]),
    ("gain:combined", "gain:combined:", []),  # which reconstruct refuses
    ("gain:combined", "tour:3", ["line 2", "tour:3", "tour:K:M"]),
    ("gain:combined", "tour:1:1", ["line 2", "tour:K:M"]),
    ("gain:combined", "tour:3:4", ["line 2", "tour:K:M"]),
    ("gain:combined", "tour:2000:1", ["line 2", "tour:K:M"]),
    ('"frontier", ', '"gain:combined", ', ["line 2", "gain:combined", "twice"]),
    ('against = "frontier"', 'against = "random"', ["line 3", "none of the policies"]),
    ('"tof.toml"', '"no.toml"', ["line 5", "no.toml"]),
    ("voxels = [0.01, 0.005]", "voxels = [0.0]", ["line 6", "positive"]),
    ("max_views = 5", "max_views = 0", ["line 7", "1..1000"]),
    ("max_views = 5", "max_views = 2.5", ["line 7", "whole"]),
    ("max_views = 5\n", "", ["max_views is missing"]),
    ("max_views", "tolerance = 0\nmax_views", ["line 7", "tolerance"]),
    ("max_views", "kept_candidates = 0\nmax_views", ["line 7", "kept_candidates"]),
    ("max_views", "max_view", ["line 7", "max_view", "max_views"]),
    ("--up=y", "--seed=4", ["line 8", "--seed"]),
    ("--up=y", "--plan=3", ["line 8", "--plan"]),
    ("--up=y", "y", ["line 8", "--up=y"]),
    ("--up=y", "--help", ["line 8", "--help"]),
])
def test_what_is_wrong_is_named_with_its_line(folder, old, new, words):
    if not words:
        spec_of(changed(old, new))
        return
    with pytest.raises(SpecError) as error:
        spec_of(changed(old, new))
    for word in ("spec.toml", *words):
        assert word in str(error.value)


def test_too_many_runs_and_missing_files(folder):
    with pytest.raises(SpecError, match="1,000,000 at most"):
        spec_of(changed("seeds = [3, 1]", f"seeds = {list(range(50_000))}"))
    with pytest.raises(SpecError, match="none.toml"):
        read_spec("none.toml")
