"""What ccs_project/plomada.projectspec says: the one description of the target build, for CCS and for the scripts here."""
import re
import shlex
import xml.etree.ElementTree as ElementTree
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[2]
SPEC = REPOSITORY / "ccs_project" / "plomada.projectspec"


class Project:
    def __init__(self, spec=SPEC):
        self.spec = Path(spec)
        project = ElementTree.parse(self.spec).getroot().find("project")
        self.attributes = project.attrib
        self.name = project.attrib["name"]
        self.properties = {each.attrib["name"]: each.attrib["value"] for each in project.findall("property")}
        self.configurations = {each.attrib["name"]: each.attrib for each in project.findall("configuration")}
        self.variables = {each.attrib["name"]: (self.spec.parent / each.attrib["path"]).resolve()
                          for each in project.findall("pathVariable")}
        self.entries = [each.attrib for each in project.findall("file")]

    def files(self, suffix):
        """Absolute paths of the project's files with this suffix."""
        return [(self.spec.parent / entry["path"]).resolve() for entry in self.entries if entry["path"].endswith(suffix)]

    def options(self, configuration, attribute, **variables):
        """The words of an option string; ${NAME} is one of the keywords, a path variable, or an error."""
        known = {**self.variables, **variables}
        words = shlex.split(self.configurations[configuration][attribute])
        return [re.sub(r"\$\{(\w+)\}", lambda match: Path(known[match.group(1)]).as_posix(), word) for word in words]

    def versions(self):
        """{product: [numbers..., qualifier]}, as text: 6.83.0.18 is 6 83 00 18 in the names of TI's directories."""
        products = dict(each.split(":") for each in self.properties["products"].split(";"))
        found = {"SYSBIOS": products["com.ti.rtsc.SYSBIOS"], "C2000WARE": products["C2000WARE"],
                 "XDCTOOLS": self.properties["xdcToolsVersion"].partition("_")[0]}
        found = {name: [part.zfill(2) for part in version.split(".")] for name, version in found.items()}
        found = {name: [parts[0].lstrip("0"), *parts[1:]] for name, parts in found.items()}
        return {**found, "CGT": [self.attributes["cgtVersion"]]}
