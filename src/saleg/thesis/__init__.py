"""The dissertation: its tables and chapters, beside what saleg computes."""
