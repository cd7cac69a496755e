"""What a flight has done to its vehicle, and what it has done that nobody asked for: the verdicts on one flight."""
from situations import DOWN_WITHIN_S, SOURCES

HIGH_MM, TOUCH_MPS, DECEIVED_S = 1200.0, 1.2, 2.0
GENTLE_MM, GENTLE_MPS = 800.0, 0.8      # what the laws are built for; the limits above are what a vehicle may survive
OFF_S = 2.0                             # of METRIC_OFF_S


def above(figures, name, limit):
    return figures[name] is not None and figures[name] > limit


def cut(figures):
    return figures["off_aloft"] > 0


def stayed(figures):
    return figures["started"] and (figures["down_s"] is None or figures["down_s"] > DOWN_WITHIN_S)


def halted(figures):
    return figures["halted"]


# When a flight is one, by the title of the verdict.
HARMS = {
    "flew up": lambda f: above(f, "highest_mm", HIGH_MM),
    "struck": lambda f: above(f, "touch_speed_mps", TOUCH_MPS),
    "cut": cut,
    "not down": stayed,
    "halted": halted,
}
GENTLE = HARMS | {
    "flew up": lambda f: above(f, "highest_mm", GENTLE_MM),
    "struck": lambda f: above(f, "touch_speed_mps", GENTLE_MPS) or f["collided"] > 0,
}
UNASKED = {
    "landed unordered": lambda f: f["landed_unordered"] > 0,
    "took over": lambda f: f["takeovers"] > 0,
    "left the height": lambda f: f["off_s"] > OFF_S,
}
DOUBTS = dict(zip(SOURCES, ("sight_doubts", "imu_doubts", "thrust_doubts"), strict=True))


def deceived(figures):
    return figures["deceived_s"] > DECEIVED_S


def harmed(figures):
    """Something happened to the vehicle that it may not survive."""
    return any(found(figures) for found in HARMS.values())


def mishandled(figures):
    """Something that no flight should do, by the limits for which the laws are built."""
    return any(found(figures) for found in GENTLE.values())


def doubts(figures, lying=()):
    """How often each source was doubted that told the truth."""
    return {source: 0 if source in lying else figures[name] for source, name in DOUBTS.items()}


def doubted(figures, lying=()):
    return any(doubts(figures, lying).values())


def wrong(figures, lying=()):
    """What a healthy flight did wrong, by the titles of the verdicts. lying: sources whose doubt is right."""
    found = [title for title, is_so in (UNASKED | GENTLE).items() if is_so(figures)]
    found += [f"doubted {source}" for source, times in doubts(figures, lying).items() if times]
    return found + ["deceived"] * deceived(figures) + ["did not start"] * (not figures["started"])


def lied_to(figures, lying):
    """What a flight did that was lied to."""
    found = [title for title, is_so in HARMS.items() if is_so(figures)]
    if not found and mishandled(figures):
        found = ["mishandled"]
    found += [f"doubted {source}" for source, times in doubts(figures, lying).items() if times]
    return found + ["deceived"] * deceived(figures)
