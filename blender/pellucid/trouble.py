"""What went wrong, for the user."""


class Trouble(Exception):
    """One sentence that says what was found and what was expected."""
