"""Laboratory 9, for all numbers: an observer with three gains. It compares an old height with what it held at that instant."""

# Of an error of the height, the share that each takes at once: found by trying. Larger ones follow the noise, smaller ones the bias too late.
HEIGHT, SPEED_PER_S, BIAS_PER_S2 = 0.25, 0.30, 0.10
KEPT = 20                       # half a second of steps


class Estimator:
    def __init__(self):
        self.height_m = 0.0
        self.speed_mps = 0.0
        self.bias_mps2 = 0.0
        self.before = []        # (step, the height at its end), the newest last
        self.first = True

    def predict(self, up_mps2, step_s):
        up = up_mps2 - self.bias_mps2
        self.height_m += self.speed_mps * step_s + 0.5 * up * step_s * step_s
        self.speed_mps += up * step_s
        self.before = [*self.before, (step_s, self.height_m)][-KEPT:]

    def at(self, age_s):
        """The height that was estimated so long ago."""
        for step_s, height_m in reversed(self.before):
            if age_s < 0.5 * step_s:
                return height_m
            age_s -= step_s
        return self.before[0][1] if self.before else self.height_m

    def correct(self, height_m, age_s):
        error_m = height_m - self.at(age_s)
        if self.first:
            self.first, share = False, 1.0
        else:
            share = HEIGHT
            self.speed_mps += SPEED_PER_S * error_m
            self.bias_mps2 -= BIAS_PER_S2 * error_m
        self.height_m += share * error_m
        self.before = [(step_s, before_m + share * error_m) for step_s, before_m in self.before]
