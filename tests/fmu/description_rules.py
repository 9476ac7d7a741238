#!/usr/bin/env python3
"""What the standard asks of modelDescription.xml beyond its schema, of version 2 and 3.

    description_rules.py FILE.fmu...

Says what is broken, and ends with status 1 then.
"""
import re
import sys
import zipfile
import xml.etree.ElementTree as ElementTree

INITIALS = {  # by causality and variability: what `initial` may be, the default first
    ("parameter", "tunable"): ("exact",),
    ("parameter", "fixed"): ("exact",),
    ("calculatedParameter", "tunable"): ("calculated", "approx"),
    ("calculatedParameter", "fixed"): ("calculated", "approx"),
    ("local", "continuous"): ("calculated", "exact", "approx"),
    ("output", "continuous"): ("calculated", "exact", "approx"),
    ("independent", "continuous"): (None,),
    ("input", "continuous"): (None,),
}


class Description:
    def __init__(self, path):
        self.archive = zipfile.ZipFile(path)
        self.path = path
        self.broken = []
        self.root = ElementTree.fromstring(self.archive.read("modelDescription.xml"))
        self.version = int(self.root.get("fmiVersion")[0])
        self.variables = list(self.root.find("ModelVariables"))
        self.by_reference = {v.get("valueReference"): v for v in self.variables}

    def value(self, variable):
        return variable.find("Real") if self.version == 2 else variable

    def expect(self, holds, text):
        if not holds:
            self.broken.append(text)

    def unknowns(self, name2, name3):
        structure = self.root.find("ModelStructure")
        if self.version == 3:
            return [self.by_reference[u.get("valueReference")] for u in structure.findall(name3)]
        part = structure.find(name2)
        return [self.variables[int(u.get("index")) - 1] for u in part] if part is not None else []

    def names(self):
        names = [v.get("name") for v in self.variables]
        self.expect(len(set(names)) == len(names), "two variables of one name")
        self.expect(all(n and n == n.strip() for n in names), "a name without letters")
        references = [v.get("valueReference") for v in self.variables]
        self.expect(len(set(references)) == len(references), "two variables of one reference")

    def kinds(self):
        count = 0
        for v in self.variables:
            name = v.get("name")
            causality, variability = v.get("causality"), v.get("variability")
            count += causality == "independent"
            allowed = INITIALS.get((causality, variability))
            self.expect(allowed is not None, f"{name}: {causality} and {variability}")
            if allowed is None:
                continue
            initial = v.get("initial", allowed[0])
            self.expect(initial in allowed, f"{name}: initial {initial}")
            has_start = self.value(v).get("start") is not None
            self.expect(has_start == (initial in ("exact", "approx") or causality == "input"),
                        f"{name}: a start, or none, and initial {initial}")
            self.expect(causality != "independent" or v.get("initial") is None,
                        f"{name}: is the independent variable and has an initial value")
        self.expect(count == 1, f"{count} independent variables")

    def derivatives(self):
        listed = self.unknowns("Derivatives", "ContinuousStateDerivative")
        for v in listed:
            of = self.value(v).get("derivative")
            self.expect(of is not None, f"{v.get('name')}: of what it is the derivative")
            state = (self.variables[int(of) - 1] if self.version == 2
                     else self.by_reference.get(of))
            self.expect(state is not None and state.get("variability") == "continuous",
                        f"{v.get('name')}: of a state")
        self.expect({id(v) for v in listed} ==
                    {id(v) for v in self.variables if self.value(v).get("derivative") is not None},
                    "the structure's derivatives are others than those of the list")

    def units(self):
        known = {}
        for unit in self.root.findall("UnitDefinitions/Unit"):
            self.expect(unit.get("name") not in known, f"{unit.get('name')}: a unit twice")
            known[unit.get("name")] = {k: int(v) for k, v in unit.find("BaseUnit").attrib.items()}
        by_place = {str(i + 1) if self.version == 2 else v.get("valueReference"): v
                    for i, v in enumerate(self.variables)}
        used = {self.value(v).get("unit") for v in self.variables} - {None}
        self.expect(used == set(known), "units that nobody has, or nobody tells")
        for v in self.variables:
            name, unit = v.get("name"), self.value(v).get("unit")
            if v.get("causality") == "independent":
                self.expect(known.get(unit) == {"s": 1}, "time is not in seconds")
            of = by_place.get(self.value(v).get("derivative"))
            if of is None or self.value(of).get("unit") is None:
                continue
            rate = dict(known[self.value(of).get("unit")])
            rate["s"] = rate.get("s", 0) - 1
            self.expect({k: p for k, p in rate.items() if p != 0} == known.get(unit),
                        f"{name}: {unit} is no rate of {self.value(of).get('unit')}")

    def structure(self):
        outputs = self.unknowns("Outputs", "Output")
        self.expect({id(v) for v in outputs} ==
                    {id(v) for v in self.variables if v.get("causality") == "output"},
                    "the structure's outputs are others than those of the list")
        self.expect(len({id(v) for v in outputs}) == len(outputs), "an output twice")
        rates = self.unknowns("Derivatives", "ContinuousStateDerivative")
        states = {self.value(v).get("derivative") for v in rates}
        places = {id(v): str(i + 1) if self.version == 2 else v.get("valueReference")
                  for i, v in enumerate(self.variables)}
        initial = self.unknowns("InitialUnknowns", "InitialUnknown")
        wanted = [v for v in self.variables
                  if v.get("causality") == "output" and v.get("initial") != "exact"
                  or v.get("causality") == "calculatedParameter"
                  or v in rates and v.get("initial") != "exact"
                  or places[id(v)] in states and v.get("initial") != "exact"]
        self.expect({id(v) for v in initial} == {id(v) for v in wanted},
                    "the structure's initial unknowns are others than those of the list")
        if self.version == 2:
            at = [int(u.get("index")) for u in
                  self.root.findall("ModelStructure/InitialUnknowns/Unknown")]
            self.expect(at == sorted(at), "initial unknowns out of order")
        known = set(places.values())
        for u in self.root.find("ModelStructure").iter():
            on = (u.get("dependencies") or "").split()
            self.expect(all(d in known for d in on), "a dependency on nobody")
            self.expect(len(set(on)) == len(on), "a dependency twice")

    def files(self):
        names = self.archive.namelist()
        self.expect(self.archive.testzip() is None, "the archive is damaged")
        self.expect("modelDescription.xml" in names, "no description")
        for kind in ("ModelExchange", "CoSimulation"):
            part = self.root.find(kind)
            if part is None:
                continue
            identifier = part.get("modelIdentifier")
            self.expect(re.fullmatch(r"[A-Za-z_]\w*", identifier), f"{identifier}: no identifier")
            if self.version == 2:
                for f in part.iter("File"):
                    self.expect("sources/" + f.get("name") in names, f"no {f.get('name')}")
            binary = [n for n in names if n.startswith("binaries/")]
            self.expect(all(re.search(rf"/{identifier}\.\w+$", n) for n in binary),
                        "a binary of another name")
        if self.version == 3:
            build = ElementTree.fromstring(self.archive.read("sources/buildDescription.xml"))
            self.expect(build.get("fmiVersion") == self.root.get("fmiVersion"),
                        "build and model description are of two versions")
            for f in build.iter("SourceFile"):
                self.expect("sources/" + f.get("name") in names, f"no {f.get('name')}")

    def check(self):
        for part in (self.names, self.kinds, self.derivatives, self.units, self.structure, self.files):
            part()
        for text in self.broken:
            print(f"{self.path}: {text}")
        return not self.broken


if __name__ == "__main__":
    sys.exit(0 if all([Description(path).check() for path in sys.argv[1:]]) else 1)
