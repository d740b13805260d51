"""A project carried the whole way: logs, reconstruction, identification."""

from alula.campaign.check import Checked, check_project
from alula.campaign.job import Job, report_of, run_project

__all__ = ["Checked", "Job", "check_project", "report_of", "run_project"]
