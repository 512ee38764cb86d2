"""The figures, one to one with the paper's: each is drawn from the tables that stand beside it."""
