"""A project carried the whole way: logs, reconstruction, identification.

Validation is in `alula.campaign.validate`, prediction in `alula.campaign.predict`, comparison in
`alula.campaign.compare`: they load what this does not need.
"""

from alula.campaign.check import Checked, check_project
from alula.campaign.job import Job, report_of, run_project

__all__ = [
    "Checked",
    "Job",
    "check_project",
    "report_of",
    "run_project",
]
