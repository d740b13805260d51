"""A project carried the whole way: logs, reconstruction, identification."""

from alula.campaign.check import Checked, check_project
from alula.campaign.compare import Comparison, run_comparison
from alula.campaign.job import Job, report_of, run_project
from alula.campaign.validate import ValidationJob, report_of_validation, run_validation

__all__ = [
    "Checked",
    "Comparison",
    "Job",
    "ValidationJob",
    "check_project",
    "report_of",
    "report_of_validation",
    "run_comparison",
    "run_project",
    "run_validation",
]
