# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""What a study's spec says."""
import os

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
    assert read_spec("spec.toml", "1").words(run) == words  # of an object in the place of those of all, see below
    (folder / "poses.txt").write_text("2")  # a file that a file names
    assert spec_of(text).runs[6].hash != before
    assert "--count=7" not in spec_of(text).words(spec_of(text).runs[0])


def test_flags_of_an_object_stand_in_the_place_of_those_of_all(folder):
    text = changed('"more/ball.off"', '{mesh = "more/ball.off", flags = ["--up=x", "--size=0.8", "--obstacle=0,0,0,1,1,1"]}').replace(
        '["--up=y"]', '["--up=y", "--obstacle=2,2,2,3,3,3", "--count=5"]')
    spec = spec_of(text)
    words = spec.words(spec.runs[-1])
    assert [word for word in words if word.startswith(("--up", "--size", "--obstacle", "--count"))] == [
        "--obstacle=2,2,2,3,3,3", "--count=5", "--up=x", "--size=0.8", "--obstacle=0,0,0,1,1,1"]
    assert "--up=y" in spec.words(spec.runs[0])
    with pytest.raises(SpecError, match="give either sizes for all objects or --size for each object"):
        spec_of(text + "sizes = [0.3]\n")


def test_the_tutorials_keys_are_all_that_there_are(folder):
    """The list of all keys in the tutorial is a spec."""
    for name in ("meshes/camel.off", "shelf.off", "arm.toml", "table.off", "mine.py"):
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_text("")
    with open(os.environ["VIEWGAIN_EXAMPLES"] + "/../docs/tutorials/study.md", encoding="utf-8") as page:
        text = page.read().partition("## All keys\n\n")[2]
    lines = [line[4:] for line in text[:text.index("\n\n")].split("\n")]
    spec = spec_of("\n".join(lines) + "\n")
    assert len(spec.runs) == 2 * 4 * 3 and spec.kept_candidates == 50
    for key in ("objects", "policies", "against", "seeds", "sensors", "voxels", "sizes", "max_views", "tolerance", "flags", "kept_candidates"):
        assert sum(line.startswith(key + " =") for line in lines) == 1, key


def test_links_keep_their_names_and_hazards_their_files(folder):
    (folder / "store").mkdir()
    (folder / "store/ab12").write_text("bytes")
    (folder / "link.off").symlink_to("store/ab12")
    (folder / "hazard.vdb").write_text("1")
    text = changed('"more/ball.off"', '"link.off"').replace('["--up=y"]', '["--hazard=size=0.3,hazard.vdb"]')
    spec = spec_of(text)
    assert spec.objects[1].name == "link" and spec.objects[1].mesh == folder / "link.off"
    assert f"--hazard=size=0.3,{folder}/hazard.vdb" in spec.words(spec.runs[0])
    (folder / "hazard.vdb").write_text("2")
    assert spec_of(text).runs[0].hash != spec.runs[0].hash


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
    ("seeds = [3, 1]", "seeds = []", ["line 4", "seeds", "at least one entry"]),
    ("seeds = [3, 1]", "seeds = [1, 1]", ["line 4", "twice"]),
    ("seeds = [3, 1]", "seeds = [-1]", ["line 4", "-1"]),
    ("seeds = [3, 1]", "seeds = [true]", ["line 4", "True"]),
    ("seeds = [3, 1]", "seeds = 3", ["line 4", "list"]),
    ("seeds = [3, 1]", "seeds = [3", ["spec.toml", "line 5"]),
    ("more/ball.off", "ball.off", ["line 1", "the file ball.off does not exist"]),
    ("more/ball.off", "./cube.off", ["line 1", "two objects with the name", "cube"]),
    ('"more/ball.off"', '{mesh = "more/ball.off", reech = "x"}', ["line 1", "'reech'", "reach"]),
    ('"more/ball.off"', '{mesh = "more/ball.off", reach = "x.toml"}', ["line 1", "x.toml"]),
    ('"more/ball.off"', '{mesh = "more/ball.off", obstacles = "x"}', ["line 1", "obstacles must be a list"]),
    ('"more/ball.off"', '{mesh = "more/ball.off", flags = ["--seed=1"]}', ["line 1", "--seed"]),
    ('"more/ball.off"', '{mesh = "more/ball.off", name = "a|b"}', ["line 1", "cannot be shown in a table"]),
    ('"frontier", ', '"gain", ', ["line 2", "'gain'", "gain:NAME"]),
    ('"frontier", ', '"frontier:x", ', ["line 2", "frontier:x"]),
    ('"frontier", ', '{name = "mine"}, ', ["line 2", "command"]),
    ("seeds = [3, 1]", "seeds = [9000000000000000000]", ["line 4", "2^62"]),
    ("voxels = [0.01, 0.005]", f"voxels = [{10**400}]", ["line 6", "positive"]),
    ('"frontier", ', '"frontier", {name = "frontier", command = "x"}, ', ["line 2", "'frontier' twice"]),
    ('"frontier", ', '{name = "gain:x", command = "x"}, ', ["line 2", "must not contain :"]),
    ('"frontier", ', """{name = "x", command = "sh -c 'x"}, """, ["line 2", "No closing quotation"]),
    ('"tof.toml"', '"tof.toml", "./tof.toml"', ["line 5", "twice"]),
    ('"more/ball.off"', '{mesh = "more/ball.off", reach = 3}', ["line 1", "3"]),
    ('"more/ball.off"', '{mesh = "more/ball.off", obstacles = ["0,0,0,1,1"]}', ["line 1", "six numbers"]),
    ('"more/ball.off"', '{name = "b"}', ["line 1", "an entry without a file"]),
    ("--up=y", "--up=y\\u0000", ["line 8", "byte"]),
    ("max_views = 5", "max_views = " + "[" * 3000 + "]" * 3000, ["is not valid TOML"]),
    ("gain:combined", "tour:3", ["line 2", "tour:3", "tour:K:M"]),
    ("gain:combined", "tour:1:1", ["line 2", "tour:K:M"]),
    ("gain:combined", "tour:3:4", ["line 2", "tour:K:M"]),
    ("gain:combined", "tour:2000:1", ["line 2", "tour:K:M"]),
    ('"frontier", ', '"gain:combined", ', ["line 2", "gain:combined", "twice"]),
    ('against = "frontier"', 'against = "random"', ["line 3", "valid policies"]),
    ('"tof.toml"', '"no.toml"', ["line 5", "no.toml"]),
    ("voxels = [0.01, 0.005]", "voxels = [0.0]", ["line 6", "positive"]),
    ("max_views = 5", "max_views = 0", ["line 7", "1..1000"]),
    ("max_views = 5", "max_views = 2.5", ["line 7", "whole"]),
    ("max_views = 5\n", "", ["max_views is missing"]),
    ("max_views", "tolerance = 0\nmax_views", ["line 7", "tolerance"]),
    ("max_views", "kept_candidates = 0\nmax_views", ["line 7", "kept_candidates"]),
    ("max_views", "max_view", ["line 7", "did you mean max_views?"]),
    ("--up=y", "--seed=4", ["line 8", "--seed"]),
    ("--up=y", "--plan=3", ["line 8", "--plan"]),
    ("--up=y", "y", ["line 8", "--up=y"]),
    ("--up=y", "--help", ["line 8", "--help"]),
])
def test_what_is_wrong_is_named_with_its_line(folder, old, new, words):
    with pytest.raises(SpecError) as error:
        spec_of(changed(old, new))
    for word in ("spec.toml", *words):
        assert word in str(error.value)


def test_too_many_runs_and_missing_files(folder):
    with pytest.raises(SpecError, match="line 4: seeds and the other lists make 1,200,000 runs.*the maximum is 1,000,000$"):
        spec_of(changed("seeds = [3, 1]", f"seeds = {list(range(50_000))}"))
    with pytest.raises(SpecError, match="none.toml"):
        read_spec("none.toml")
