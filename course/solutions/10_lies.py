"""Laboratory 10, for all numbers: a height must fit to the motion that is felt; or two in a row must agree that the ground has changed."""

LEAST_MM, MOST_MM = 20, 4094    # what the scanner can measure: others are codes
STEP_S = 0.1
FITS_MM = 100.0                 # far more than noise, less than the edges and lies that matter
SAME_MOST = 5                   # noise makes no six equal heights
HEIGHT, SPEED_PER_S = 0.4, 1.0  # as in laboratory 9


class Judge:
    def __init__(self):
        self.height_mm = None
        self.speed_mm_s = 0.0
        self.doubted_mm = None  # off by so much was the height before, when it was doubted
        self.last_mm = None
        self.same = 0

    def frozen(self, height_mm):
        self.same = self.same + 1 if height_mm == self.last_mm else 0
        self.last_mm = height_mm
        return self.same >= SAME_MOST

    def believe(self, time_s, height_mm, up_mps2):
        if self.height_mm is None:
            self.height_mm = height_mm
        up_mm_s2 = up_mps2 * 1000.0
        self.height_mm += self.speed_mm_s * STEP_S + 0.5 * up_mm_s2 * STEP_S * STEP_S
        self.speed_mm_s += up_mm_s2 * STEP_S
        if self.frozen(height_mm) or not LEAST_MM <= height_mm <= MOST_MM:
            self.doubted_mm = None
            return False
        error_mm = height_mm - self.height_mm
        if abs(error_mm) > FITS_MM:
            if self.doubted_mm is None or abs(error_mm - self.doubted_mm) > FITS_MM:
                self.doubted_mm = error_mm
                return False
            self.height_mm = height_mm  # two agree: it is the ground
        else:
            self.height_mm += HEIGHT * error_mm
            self.speed_mm_s += SPEED_PER_S * error_mm
        self.doubted_mm = None
        return True
