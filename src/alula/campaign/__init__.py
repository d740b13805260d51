"""A project carried the whole way: logs, reconstruction, identification."""

from alula.campaign.job import Checked, Job, check_project, report_of, run_project

__all__ = ["Checked", "Job", "check_project", "report_of", "run_project"]
