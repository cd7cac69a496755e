"""The IMU: axes that are others than the firmware believes, and a body that shakes."""
import numpy

from causes.case import Finding, wider

ARM_M = 0.3                     # height per radian of tilt: the front mirror stands 0.22 m beside the centre
ARM_HEALTHY_M = 0.03            # what mounting and lag leave
WORTH_ANEW = 1.0
FREQUENCY_HZ = numpy.arange(0.8, 19.0, 0.04)
SHAKE_MPS2 = 1.0                # rms of a line's amplitude
NOISE_MPS2, NOISE_HEALTHY, NOISE_FAULTY = 0.5, 0.35, 1.2    # of the accelerometer: logarithms


def tilt_columns(span, _f):
    tilt = numpy.column_stack([span.roll, span.pitch])
    return span.merged(tilt, numpy.zeros((len(span.frame_s), 2)))


def axes(case):
    _, size, spread = case.model.gain(tilt_columns, 10.0)
    nats, model = sum(wider(float(s), float(e), ARM_HEALTHY_M, ARM_M) for s, e in zip(size, spread)), None
    if nats > WORTH_ANEW:
        nats, model = case.again(extra=[tilt_columns], sigmas=[ARM_M] * 2)
        size = model.linear[-2:]
    return Finding(nats, {"roll_mm": 1e3 * float(size[0]), "pitch_mm": 1e3 * float(size[1])}, model)


def lines_of(frequency_hz):
    def columns(span, _f):
        angle = 2.0 * numpy.pi * numpy.outer(span.frame_s, frequency_hz)
        felts = numpy.hstack([numpy.cos(angle), numpy.sin(angle)])
        return span.merged(numpy.zeros((len(span.ray_s), felts.shape[1])), felts)
    return columns


def shake(case):
    """(nats, Hz, sizes of cosine and sine) of the likeliest line in the accelerations."""
    if case.shake is None:
        nats, size, _ = case.model.gain(lines_of(FREQUENCY_HZ), SHAKE_MPS2)
        count = len(FREQUENCY_HZ)
        both = nats[:count] + nats[count:]
        best = int(numpy.argmax(both))
        case.shake = float(both[best]) - numpy.log(count), float(FREQUENCY_HZ[best]), size[[best, best + count]]
    return case.shake


def vibration(case):
    line, hz, size = shake(case)
    noise = case.model.figures["acc_noise"]
    off = numpy.log(noise / NOISE_MPS2)
    hiss = wider(off, 0.03, NOISE_HEALTHY, NOISE_FAULTY) if off > 0.0 else -2.0
    words = {"hz": hz, "mps2": float(numpy.hypot(*size)), "noise": noise, "line": line > hiss}
    if line > WORTH_ANEW:
        gained, model = case.again(extra=[lines_of(numpy.array([hz]))], sigmas=[SHAKE_MPS2] * 2)
        return Finding(max(gained - numpy.log(len(FREQUENCY_HZ)), hiss), words, model)
    return Finding(max(line, hiss), words)
