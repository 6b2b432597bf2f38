"""How errors in ULP are written."""


def error_text(max_ulp):
    """With so many digits that an error above half an ULP does not look like half an ULP."""
    return next(text for text in (f'{max_ulp:.{digits}g}' for digits in range(4, 18))
                if (float(text) > 0.5) == (max_ulp > 0.5))
