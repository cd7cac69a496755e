"""Laboratory 10: a sensor that lies. Fill in believe(); add what you must remember."""


class Judge:
    def __init__(self):
        self.before_mm = None

    def believe(self, time_s, height_mm, up_mps2):
        """Is this height to be believed? Called every 0.1 s: the height, and the mean acceleration since the height before."""
        return True
