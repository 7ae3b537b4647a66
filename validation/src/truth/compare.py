"""Two pictures of a drop, one number each for what an eye sees and for the light, and a picture of the difference."""

import flip_evaluator
import mitsuba as mi
import numpy as np

# FLIP's default: an eye 0.7 m from a screen of 3840 pixels on 0.7 m.
PIXELS_PER_DEGREE = 67.0
# Where the logarithmic mean of the reference within the silhouette goes.
GRAY = 0.18
# Pixels between the panels of the picture.
GAP = 4


def luminance(picture):
    """Luminance of linear BT.709."""
    return picture @ np.array([0.2126, 0.7152, 0.0722])


def mean_luminance(picture, within):
    return float(luminance(picture.astype(np.float64))[within].mean())


def exposure(reference, within):
    """The factor, one for both pictures, that puts the reference's logarithmic mean at middle gray."""
    values = np.maximum(luminance(reference)[within], 1.0e-6)
    return float(GRAY / np.exp(np.log(values).mean()))


def encoded(picture, factor):
    """The transfer function of sRGB (IEC 61966-2-1); what is too bright is cut."""
    linear = np.clip(picture * factor, 0.0, 1.0)
    low = linear <= 0.0031308
    return np.where(low, 12.92 * linear, 1.055 * np.maximum(linear, 0.0031308) ** (1 / 2.4) - 0.055).astype(np.float32)


def flip(reference, test, magma=False):
    """The map of LDR-FLIP (Andersson et al. 2020) of two encoded pictures, in 0 to 1, or its colors."""
    parameters = {"ppd": PIXELS_PER_DEGREE}
    result, _, _ = flip_evaluator.evaluate(reference, test, "LDR", True, magma, False, parameters)
    return np.array(result)


def mean_flip(reference, test, within, factor):
    errors = flip(encoded(reference, factor), encoded(test, factor))
    return float(errors.reshape(within.shape)[within].mean())


def beside(reference, test, factor, file):
    """A PNG of the test, the reference and the map of FLIP."""
    reference, test = encoded(reference, factor), encoded(test, factor)
    gap = np.ones((reference.shape[0], GAP, 3), np.float32)
    panels = np.concatenate([test, gap, reference, gap, flip(reference, test, magma=True)], axis=1)
    mi.Bitmap((panels * 255.0 + 0.5).astype(np.uint8)).write(file)
