"""Laboratory 9: an estimator. Fill in the two methods; add what you must remember."""


class Estimator:
    def __init__(self):
        self.height_m = 0.0     # now
        self.speed_mps = 0.0    # now, > 0 is upwards
        self.bias_mps2 = 0.0    # what the accelerometer shows too much

    def predict(self, up_mps2, step_s):
        """Called every 0.025 s: the acceleration that was measured, and the time since the call before."""

    def correct(self, height_m, age_s):
        """Called every 0.1 s: a height that was true age_s ago."""
        self.height_m = height_m
