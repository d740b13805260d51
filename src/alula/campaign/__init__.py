"""A project carried the whole way: logs, reconstruction, identification.

Validation is in `alula.campaign.validate`: it loads the simulator.
"""

from alula.campaign.check import Checked, check_project
from alula.campaign.compare import Comparison, run_comparison
from alula.campaign.job import Job, report_of, run_project

__all__ = [
    "Checked",
    "Comparison",
    "Job",
    "check_project",
    "report_of",
    "run_comparison",
    "run_project",
]
