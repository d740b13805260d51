"""Aerodynamic models: formulas as text, terms and their names, AeroModel and its file."""

from alula.model.aero_model import AXES, AeroModel, Reference, aero_model
from alula.model.file import load_model, model_text, save_model
from alula.model.grammar import parse, reference_scales, regressors
from alula.model.lookup import LookupTable, lookup_table
from alula.model.stall import Stall
from alula.model.table import TableParts, evaluate_in_core, table_parts, to_table
from alula.model.terms import COEFFICIENTS, LIFT, VARIABLES, Factor, Term

__all__ = [
    "AXES",
    "COEFFICIENTS",
    "LIFT",
    "VARIABLES",
    "AeroModel",
    "Factor",
    "LookupTable",
    "Reference",
    "Stall",
    "TableParts",
    "Term",
    "aero_model",
    "evaluate_in_core",
    "load_model",
    "lookup_table",
    "model_text",
    "parse",
    "reference_scales",
    "regressors",
    "save_model",
    "table_parts",
    "to_table",
]
