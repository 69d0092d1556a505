"""Pictures and pages of what ``workbench.findings`` holds; nothing is computed here but what a picture needs."""

from workbench.report.pages import write_comparison_report, write_diagnosis_report, write_ledger_report
from workbench.report.validation import write_validation_report

__all__ = ["write_comparison_report", "write_diagnosis_report", "write_ledger_report", "write_validation_report"]
