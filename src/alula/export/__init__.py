"""Models out to other programs, and in: DAVE-ML (AIAA S-119) both ways, JSBSim."""

from alula.export.daveml import Exported, export_daveml
from alula.export.daveml_import import Imported, import_daveml
from alula.export.daveml_model import DaveModel
from alula.export.daveml_read import parse_daveml, read_daveml
from alula.export.jsbsim import JsbsimExport, export_jsbsim

__all__ = [
    "DaveModel",
    "Exported",
    "Imported",
    "JsbsimExport",
    "export_daveml",
    "export_jsbsim",
    "import_daveml",
    "parse_daveml",
    "read_daveml",
]
