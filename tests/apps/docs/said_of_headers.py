# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""What the words of the headers say: units, frames, shapes, errors, cost and thread safety, read off Doxygen's XML.

Each rule asks the functions, data members or classes that it concerns, by their types, and looks for what it wants in
their words. As a reader does, it takes for the words of a name also

    those of the name before it, where its own refer to that ("The same", "As above", "likewise"),
    those of the function that it overrides, and those of what it names in "See X()" or "as X()",
    of its class and its header the sentences that name what is asked about, or that speak for all members,
    and for a C header, which says so, those of viewgain.h.

A unit of a parameter counts in a sentence that names the parameter; a member's own words are about it anyway.
"""
import re
import xml.etree.ElementTree as ElementTree
from collections import Counter

RETURNED = "what it returns"
RULES = ("units", "frames", "shapes", "errors", "cost", "threads")

# The fewest names of each rule: less, and the headers were not read.
LEAST = {"units": 550, "frames": 110, "shapes": 280, "errors": 360, "cost": 230, "threads": 50}

# (rule, name): why it is not asked.
TEXT = "turns numbers of its caller into text, or back: their unit is his"
EXEMPT = {
    ("units", "viewgain::short_text"): TEXT,
    ("units", "viewgain::exact_text"): TEXT,
    ("units", "viewgain::LineReader::number"): TEXT,
    ("units", "viewgain::LineReader::finite_number"): TEXT,
    ("frames", "viewgain::StopMemory::area_shares"): "three shares, no coordinates",
}

# ---- Whom a rule asks, by type ----

NUMBER = re.compile(r"\b(double|float|Vector[23][df])\b")
PLACED = re.compile(r"\b(Isometry3d|Vector3d|Matrix3d|Pose|Box)\b|\barray< *double, *3 *>")
LIST = re.compile(r"\b(span|vector) *<|\b(double|float|size_t|u?int(8|32|64)_t) *(const *)?\*|\b(double|float|int32_t) *\[")
# What takes work in proportion to its size.
LARGE = re.compile(
    r"\b(span|vector) *<|\b(BeliefGrid|GridSnapshot|VoxelScene|SurfaceScene|ClassicMap|OccupancyCodes|HazardVolume|HazardField"
    r"|DepthFrame|Measurements|FrameSequence|Recording|GrayImage|Gray8Image|RgbImage|SurfaceMesh|TriangleMesh|EstimatedViews"
    r"|Proposal|PointCloud|OcTree|path|vg_(grid|scene|planner|integrator|evaluator|feasibility))\b")

# ---- What is said ----

UNITS = {"m", "mm", "rad", "nat", "px", "s", "sr", "hz", "bytes", "voxels", "cells", "rays", "lengths", "spacings", "unit"}
# Words that say that there is no unit, or whose it is.
NO_UNIT = re.compile(
    r"\b(shares?|ratio|probability|chances?|a count|weights?|factors?|cosine|log[- ]odds|coefficients|multiples|quaternion"
    r"|in (nats|metres|radians|sigmas|spacings|standard deviations)|in (the|a|an|its|their) ([\w']+ )*unit|unit of|whatever unit"
    r"|unit (vector|normal|direction|length|surface)s?|need not be unit|in units of|0\.\.1)\b|^unit,|[\[(]0, 1[\])]", re.I)
# A frame of coordinates: a frame alone may be a depth image.
FRAME = re.compile(
    r"\bT_\w+|\bworld\b|\b(grid|camera|flange|sensor|tree|mesh|file|points?|local|optical)(['’]s?)?( own)? (frame|axes)\b"
    r"|\b[a-z]'s frame\b|\bin (any|whatever|the same|its|their|one) frame\b|\bin the( \w+)? frame (of|that|with)\b"
    r"|\bin voxels\b", re.I)
FRAME_IN_NAME = re.compile(r"(^|_)(T_|world|grid|camera|flange|sensor)|^T$|^voxel")
# How many, and in which order.
SHAPE = re.compile(
    r"\brow by row|\bby rows\b|, rows\b|-major\b|\[x\]\[y\]\[z\]|\bwidth \* height|\d x \d|\d \* \w+|\border\b|\bascending\b"
    r"|\brising\b|\bx, y, z\b|\b(best|nearest|largest gain|lowest) first\b|\b(entry|result|row|vertex|edge|line|pose) i\b"
    r"|^of (each|those)\b|\bas many as\b|\bcapacity\b|\b(numbers|indices|doubles) each\b"
    r"|\b(one|two|three|four|entry|result|row|line|place|numbers|indices|normal|covariance|face|\d+)"
    r" (a|an|each|per|(of|for) each) \w+|\b(\d+|two|three) (\w+ )?(numbers|doubles|values|indices|entries)\b", re.I)
# What becomes of an argument that is wrong, or that nobody looks.
ERROR = re.compile(
    r"\b[Tt]hrow(s|n)?\b|\b[Rr]efuse[sd]?\b|\b[Ff]ails?\b|\bError\(|\bVG_[A-Z]|\b[Cc]hecks? nothing|\b(un|not )checked\b"
    r"|\bmust\b|\b([Nn]othing|[Nn]ull|[Nn]one|NaN|[Ii]nfinity|[Uu]nknown|[Ff]alse|kUnknown|0)"
    r" (outside|if|for|where|without|unless|beyond|while)\b")
COST = re.compile(
    r"\bCosts?\b(?! (are|per|do)\b)|\bcosts (a|an|as|about|one|some|what|up to|no|O|constant)\b|\bO\(|\b[Cc]onstant time"
    r"|\d ?(ns|µs|ms|s)\b|\bseconds for\b|\b(micro|milli)seconds\b|\bsome µs|\bhalf a microsecond|\b[Pp]ass(es)? over\b"
    r"|\bgrows? with\b|\b[Tt]akes? (longer|as long|three times|some seconds)")
THREADS = re.compile(
    r"\bthread[- ]saf|\b(from|by|to) (many|any|distinct) threads?\b|\bon its own thread|\bone call at a time|\brun beside"
    r"|\bat once|\bvalue type", re.I)
# A sentence of a class or of a header for all of its members.
FOR_ALL = re.compile(r"\b(members?|functions?|calls?|values? type|every failure|parts|all of them|they all)\b|^Costs?\b", re.I)
REFERS = re.compile(r"^(the same|as above|likewise)\b|\blikewise\b", re.I)


def words_of(element):
    texts = (element.find(tag) for tag in ("briefdescription", "detaileddescription"))
    return re.sub(r"\s+", " ", " ".join("".join(text.itertext()) for text in texts if text is not None)).strip()


def needs_none(member, of):
    """Is it a function of which the language says what it does?"""
    name, arguments = member.findtext("name"), (member.findtext("argsstring") or "").replace(" ", "")
    if name.startswith("~") or arguments.endswith("=delete"):
        return True
    if name.startswith("operator") and arguments.endswith("=default"):
        return True
    return name in (of, "operator=") and arguments.startswith((f"({of}&&", f"(const{of}&"))


def sentences(words):
    return re.split(r"(?<=[.:;])\s+", words)


def has_unit(text, after=0):
    """A unit in brackets, or a word in its place; the brackets from a position on, as they follow what they are of."""
    for match in re.finditer(r"(?<![\w\])])\[([^\[\]]+)\]", text):
        parts = (re.sub(r"[\d.^²³¹⁰⁴-⁹⁻-]+$", "", part).lower() for part in re.split(r"[ ,:()·/]+", match[1]))
        if match.start() >= after and (match[1] == "1" or any(part in UNITS for part in parts)):
            return True
    return NO_UNIT.search(text) is not None


def gives_unit(sentence, name):
    return speaks_of(sentence, name) and has_unit(sentence, place_of(sentence, name))


def speaks_of(sentence, name):
    """Does it have the name, or the words of which the name is made?"""
    if re.search(rf"(?<!\w){re.escape(name)}(?!\w)", sentence):
        return True
    parts = [part for part in name.split("_") if part]
    return len(name) > 1 and all(re.search(rf"\b{re.escape(part.rstrip('s'))}", sentence, re.I) for part in parts)


def place_of(sentence, name):
    found = re.search(rf"(?<!\w){re.escape(name)}(?!\w)", sentence) or re.search(
        rf"\b{re.escape(name.split('_')[0].rstrip('s'))}", sentence, re.I)
    return found.start() if found else 0


def subject(name, thing):
    """What sentences call a parameter, a member or what a function returns: of poses_of() the poses."""
    if thing != RETURNED:
        return thing
    return [part for part in name.split("_") if len(part) > 2][-1]


def type_of(element, tag="type"):
    """The type without what callables take and without references."""
    found = element.find(tag)
    text = "".join(found.itertext()) if found is not None else ""
    return re.sub(r"function *<.*>", "function", text) + (element.findtext("array") or "")


class Name:
    """A function or a data member: its types and its words."""

    def __init__(self, element, scope, words):
        self.element, self.scope, self.name = element, scope, element.findtext("name")
        place = element.find("location")
        self.file, self.line = place.get("declfile") or place.get("file"), int(place.get("declline") or place.get("line"))
        self.full = f"{scope}::{self.name}" if scope else self.name
        arguments = element.findtext("argsstring") or ""
        self.is_function = element.get("kind") == "function"
        self.is_noexcept = "noexcept" in arguments.split(")")[-1] or element.get("noexcept") == "yes"
        self.type = type_of(element) + ("" if self.is_function else arguments)
        parameters = ((param.findtext("declname") or "", type_of(param)) for param in element.findall("param"))
        self.parameters = [(name, kind) for name, kind in parameters if kind not in ("void", "")]
        self.own = words
        self.words = words  # with those of others that they refer to

    def things(self):
        """(what, its type) of all that a rule may ask about."""
        return [(RETURNED if self.is_function else self.name, self.type), *self.parameters]


class Headers:
    """All that Doxygen has found, in its folder `xml`. With `instead` every word is replaced by these."""

    def __init__(self, folder, instead=None):
        self.names, self.classes, self.files, self.words = [], {}, {}, {}
        by_id, of_compound = {}, {}

        def words(element):
            return words_of(element) if instead is None else instead

        for path in sorted(folder.glob("*.xml")):
            for compound in ElementTree.parse(path).getroot().findall("compounddef"):
                kind, scope = compound.get("kind"), compound.findtext("compoundname")
                of_compound[compound.get("id")] = words(compound)
                if kind == "file":
                    self.files[compound.find("location").get("file")] = words(compound)
                    scope = ""
                elif kind in ("class", "struct") and compound.get("prot") != "private" and "detail" not in scope.split("::"):
                    self.classes[scope], self.words[scope] = compound, words(compound)
                elif kind != "namespace" or "detail" in scope.split("::"):
                    continue
                for member in compound.iter("memberdef"):
                    if member.get("prot") == "private" or member.get("kind") not in ("function", "variable"):
                        continue
                    if member.get("id") not in by_id and not needs_none(member, scope.split("::")[-1]):
                        by_id[member.get("id")] = name = Name(member, scope, words(member))
                        self.names.append(name)
        self.names.sort(key=lambda name: (name.file, name.line))
        self._follow(by_id, of_compound)

    def _follow(self, by_id, of_compound):
        """Adds the words that others refer to."""
        before = {}
        for name in self.names:
            place = (name.file, name.scope, name.is_function)
            if place in before and REFERS.search(name.own):
                name.words += " " + before[place].words
            before[place] = name
        for name in self.names:
            for tag in name.element.findall("reimplements"):
                if tag.get("refid") in by_id:
                    name.words += " " + by_id[tag.get("refid")].words
            if re.match(r"(See|As|as)\b", name.own):
                for tag in name.element.iter("ref"):
                    found = by_id.get(tag.get("refid"))
                    name.words += " " + (found.own if found is not None else of_compound.get(tag.get("refid"), ""))

    def around(self, name):
        """Sentences of the class of a name, of those it is in, and of its header."""
        scope, words = name.scope, [self.files.get(name.file, "")]
        while scope:
            words.append(self.words.get(scope, ""))
            scope = scope.rpartition("::")[0]
        if name.file.endswith(".h") and "viewgain/viewgain.h" in words[0]:
            words.append(self.files["viewgain/viewgain.h"])
        return [sentence for text in words for sentence in sentences(text)]


# ---- The rules: each gives (what it asks about, whether it is said) ----


def units(headers, name):
    around = headers.around(name)
    for thing, kind in name.things():
        if not thing or not NUMBER.search(kind):
            continue
        identifier = name.name if thing == RETURNED else thing
        said = has_unit(identifier.replace("_", " ").replace("cos ", "cosine ")) or any(
            gives_unit(words, identifier) or words.startswith("Units are ") for words in around)
        if thing in (RETURNED, name.name):
            yield thing, said or has_unit(name.words)
        else:
            yield thing, said or any(gives_unit(words, thing) for words in sentences(name.words))


def frames(headers, name):
    around = headers.around(name)
    for thing, kind in name.things():
        if not PLACED.search(kind) or FRAME_IN_NAME.search(thing) or FRAME_IN_NAME.search(name.name):
            continue
        yield thing, FRAME.search(name.words) is not None or any(
            FRAME.search(words) and (re.search(r"\b(frame|world)\b", words, re.I) or speaks_of(words, subject(name.name, thing)))
            for words in around)


def shapes(headers, name):
    around = headers.around(name)
    for thing, kind in name.things():
        if not LIST.search(kind):
            continue
        # "*found says how many": not an array.
        is_one = kind.endswith("*") and "const" not in kind and re.search(rf"\*{thing}\b", name.words) is not None
        yield thing, is_one or SHAPE.search(name.words) is not None or any(
            SHAPE.search(words) and speaks_of(words, subject(name.name, thing)) for words in around)


def errors(headers, name):
    if name.is_function and name.parameters and not name.is_noexcept and name.type != "vg_status":
        yield "arguments", ERROR.search(name.words) is not None or any(
            ERROR.search(words) and FOR_ALL.search(words) for words in headers.around(name))


def cost(headers, name):
    kinds = [kind for _, kind in name.parameters] + ([] if name.type.endswith("&") else [name.type])
    is_look = name.is_noexcept and not name.parameters
    if name.is_function and not is_look and any(LARGE.search(kind) for kind in kinds):
        yield "large ones", COST.search(name.words) is not None or any(
            COST.search(words) and FOR_ALL.search(words) for words in headers.around(name))


def threads(headers, scope):
    """Of classes, and of structs with members that change them."""
    compound, of = headers.classes[scope], scope.split("::")[-1]
    changes = any(member.get("kind") == "function" and member.get("prot") == "public" and member.get("static") == "no"
                  and member.get("const") == "no" and member.findtext("name") != of and not needs_none(member, of)
                  for member in compound.iter("memberdef"))
    if changes or compound.get("kind") == "class":
        bases = [base.text for base in compound.findall("basecompoundref")]
        words = [headers.words.get(name, "") for name in (scope, *bases)]
        words.append(headers.files.get(compound.find("location").get("file"), ""))
        yield "members", any(THREADS.search(text) for text in words)


def said_of(headers):
    """(how many names, {rule: how many were asked}, what is not said as (rule, line))."""
    asked, faults, exempt = dict.fromkeys(RULES, 0), [], set()

    def look(rule, answers, place, full):
        for thing, is_said in answers:
            if (rule, full) in EXEMPT:
                exempt.add((rule, full))
                continue
            asked[rule] += 1
            if not is_said:
                faults.append((rule, f"{place}: {full} says nothing of {rule}: {thing}"))

    for name in headers.names:
        for rule in (units, frames, shapes, errors, cost):
            look(rule.__name__, rule(headers, name), f"{name.file}:{name.line}", name.full)
    for scope, compound in headers.classes.items():
        place = compound.find("location")
        look("threads", threads(headers, scope), f"{place.get('file')}:{place.get('line')}", scope)
    assert exempt == set(EXEMPT), set(EXEMPT) - exempt
    return len(headers.names) + len(headers.classes), asked, faults


def unsaid_of(folder):
    """What is not said, a line each; says how much was looked at. Empty words must not pass."""
    count, asked, faults = said_of(Headers(folder))
    lacking = Counter(rule for rule, _ in faults)
    print(f"{count} functions, members and classes: "
          + ", ".join(f"{rule} {asked[rule]} asked, {lacking[rule]} unsaid" for rule in RULES))
    for rule, least in LEAST.items():
        assert asked[rule] >= least, f"{rule}: only {asked[rule]} names asked"
    _, _, of_empty_words = said_of(Headers(folder, "Does what its name says, with all that it takes."))
    passing = {rule: asked[rule] - n for rule, n in Counter(rule for rule, _ in of_empty_words).items()}
    # An identifier may tell a unit or a frame: max_near_share, p_world.
    assert all(passing[rule] == 0 for rule in ("shapes", "errors", "cost", "threads")), passing
    assert all(passing[rule] < asked[rule] / 5 for rule in ("units", "frames")), passing
    return [line for _, line in faults]
