"""docs/hardware.md and docs/flashing.md say what the sources and the project say."""
import re
import unittest
import xml.etree.ElementTree as ElementTree

from here import REPOSITORY, Project, code, constant, tables, text
import roots

HARDWARE, FLASHING = "docs/hardware.md", "docs/flashing.md"


def board_pins():
    """[(header, GPIO, function, direction)] from bsp/board.c's table and its comments."""
    rows = re.findall(r"\{SYSCTL_PERIPH_CLK_\w+, (\d+)U, GPIO_(\d+)_(\w+), (\d+)U, GPIO_(\d+)_(\w+)\}, /\* (J[\d.]+), (J[\d.]+) \*/",
                      text("bsp/board.c"))
    pins = []
    for tx, tx_config, tx_name, rx, rx_config, rx_name, tx_header, rx_header in rows:
        assert (tx, rx) == (tx_config, rx_config)
        pins += [(tx_header, f"GPIO{tx}", f"SCI{tx_name[-1]} TX", "to"), (rx_header, f"GPIO{rx}", f"SCI{rx_name[-1]} RX", "from")]
    return pins


def geometry():
    """{mirror: (d, l, L)} in whole millimetres: the defaults of the parameters that control/altitude.c puts there."""
    defaults = {name: int(float(each)) for name, each in re.findall(
        r"\[PARAMETER_(\w+)\] = \{\"\w+\", \"mm\", [\d.]+F, [\d.]+F, ([\d.]+)F", code("control/parameters.c"))}
    places = re.findall(r"\[MIRROR_(\w+)\] = \{mm\[PARAMETER_(\w+)\], mm\[PARAMETER_(\w+)\], (\w+)", code("control/altitude.c"))
    arms = {"mm": defaults["L"], "abeam_mm": defaults["L"] - defaults["DF"]}
    return {mirror: (defaults[distance], defaults[leg], arms[arm]) for mirror, distance, leg, arm in places}


class Wiring(unittest.TestCase):
    def setUp(self):
        self.rows = {row[0]: row for row in tables(HARDWARE) if len(row) == 7}

    def test_every_pin_of_the_board_is_in_the_table_and_no_other(self):
        pins = board_pins() + [("J8.80", "GPIO2", "EPWM2A", "to"), ("J8.79", "GPIO3", "selector", "from"), ("J8.78", "GPIO10", "eCAP1", "from"),
                               ("J3.27", "ADCINA0", "ADC A", "from")]
        self.assertEqual(len(pins), 10)
        for header, *expected in pins:
            self.assertEqual(self.rows[header][1:4], expected, header)
        self.assertEqual(sorted(row for row in self.rows if row.startswith("J")), sorted(pin[0] for pin in pins))
        self.assertIn("GPIO_2_EPWM2A", code("bsp/throttle.c"))
        self.assertIn("ePWM2A (GPIO2, J8.80)", text("bsp/throttle.h"))
        self.assertIn("GPIO_setPinConfig(GPIO_3_GPIO3)", code("bsp/selector.c"))
        self.assertIn("GPIO3 (J8.79), high = this firmware, low = the pilot", text("bsp/selector.h").replace("\n * ", " "))
        self.assertIn("high = LaunchPad, low = pilot", self.rows["J8.79"][5])
        self.assertIn("GPIO_setPinConfig(GPIO_10_GPIO10)", code("bsp/receiver.c"))
        self.assertIn("pulses on GPIO10 (J8.78), timed by eCAP1", text("bsp/receiver.h").replace("\n * ", " "))
        self.assertIn("ADC_CH_ADCIN0,", code("bsp/voltmeter.c"))
        self.assertIn("ADCINA0 (J3.27), ADC A", text("bsp/voltmeter.h").replace("\n * ", " "))

    def test_rates_are_the_firmwares(self):
        rates = {"SCIA": (constant("firmware/mounting.h", "LASER_FIRST_RATE"), constant("firmware/mounting.h", "LASER_STREAM_RATE")),
                 "SCIB": (constant("firmware/imu_port.c", "IMU_BIT_RATE"),),
                 "SCIC": (constant("firmware/xbee_port.c", "XBEE_BIT_RATE"),)}
        for row in self.rows.values():
            if row[2].startswith("SCI"):
                self.assertEqual(tuple(int(each) for each in re.findall(r"\d{4,}", row[6])), rates[row[2][:4]])

    def test_leds_are_those_of_the_bsp(self):
        header = text("bsp/led.h")
        for led, gpio in (("red LD9", "GPIO12"), ("blue LD10", "GPIO13")):
            self.assertIn(f"{led} = {gpio}", header)
            colour, name = led.split()
            self.assertIn(f"| {gpio} | LED {name}, {colour} |", text(HARDWARE))

    def test_the_drawing_shows_every_pin_and_is_well_formed(self):
        drawing = "\n".join(element.text or "" for element in ElementTree.parse(REPOSITORY / "docs/images/wiring.svg").iter())
        for header, gpio, function, _ in board_pins() + [("J8.80", "GPIO2", "ePWM2A", "to"), ("J8.79", "GPIO3", "selector", "from"),
                                                         ("J8.78", "GPIO10", "eCAP1", "from"), ("J3.27", "ADCINA0", "ADC A", "from")]:
            self.assertRegex(drawing, rf"{gpio} {function}\s+{re.escape(header)}\b")

    def test_pulse_and_period_are_the_throttles(self):
        tick_us = 0.48
        period = (constant("bsp/throttle.h", "BSP_THROTTLE_PERIOD_COUNTS") + 1) * tick_us / 1000
        idle = constant("bsp/throttle.h", "BSP_THROTTLE_IDLE_COUNTS") * tick_us / 1000
        full = constant("bsp/throttle.h", "BSP_THROTTLE_FULL_COUNTS") * tick_us / 1000
        self.assertEqual((round(period, 1), round(idle, 2), round(full, 2)), (13.6, 2.0, 1.0))
        self.assertIn("13.6 ms, high for 1 to 2 ms", self.rows["J8.80"][6])
        self.assertIn("**2 ms is no thrust, 1 ms is full thrust.**", " ".join(text(HARDWARE).split()))

    def test_the_leds_blink_at_the_pace_of_the_task_that_drives_them(self):
        period = constant("firmware/schedule.h", "SEND_LASER_PERIOD_MS")
        self.assertEqual(len(re.findall(rf"blinks, {period} ms on and off", text(HARDWARE))), 2)


class Bracket(unittest.TestCase):
    COLUMNS = {"FRONT": 1, "AFT": 2, "FORE": 3}

    def row(self, begins):
        rows = tables(HARDWARE)
        (row,) = [row for row in rows if row[0] == begins] or [row for row in rows if row[0].startswith(begins)]
        return row

    def test_every_distance_is_the_one_that_the_height_is_computed_with(self):
        self.assertEqual(len(geometry()), 3)
        for mirror, distances in geometry().items():
            column = self.COLUMNS[mirror]
            for begins, expected in zip(("scanner to mirror, d", "mirror to the lowest", "vehicle's centre to"), distances):
                self.assertEqual(int(re.search(r"(\d+) mm", self.row(begins)[column]).group(1)), expected, (mirror, begins))

    def test_directions_and_steps_are_the_scanners(self):
        self.assertEqual(self.row("step")[1:], ["384", "128", "640"])
        for (degrees, step) in zip(self.row("direction")[1:], (384, 128, 640)):
            self.assertEqual(round((float(degrees.rstrip("°")) - 120) / (360 / 1024)) + 384, step)
        layouts = code("drivers/scip_layout.c")
        groups = re.search(r"\"three-mirrors\".*", layouts, re.DOTALL).group()
        aft, front, fore = re.findall(r"\{\s*(\d+)U, (\d+)U\s*\}", groups)
        self.assertEqual(self.row("steps in use")[1:], [" to ".join(group) for group in (front, aft, fore)])

    def test_the_drawing_has_the_same_numbers_and_is_well_formed(self):
        drawing = " ".join(element.text or "" for element in ElementTree.parse(REPOSITORY / "docs/images/bracket.svg").iter())
        for distance, leg, arm in geometry().values():
            self.assertIn(f"d = {distance}, l = {leg}", drawing)
            self.assertRegex(drawing, rf"\b{arm} mm")
        for step in (128, 384, 640):
            self.assertIn(f"step {step}", drawing)


class Versions(unittest.TestCase):
    def test_the_page_has_the_projects_versions_and_directories(self):
        page, versions = text(FLASHING), Project().versions()
        for name in ("SYSBIOS", "XDCTOOLS", "C2000WARE"):
            self.assertIn(f"| {'.'.join(versions[name])} |", page)
        self.assertIn(f"| {versions['CGT'][0].replace('.LTS', ' LTS')} |", page)
        for variable, (what, _, _) in roots.wanted(Project()).items():
            self.assertIn(f"`{variable}`", page)
            if variable != "CCS_ROOT":
                self.assertIn(f"`{what.split(', ')[1]}`", page)

    def test_no_page_names_another_version_of_these(self):
        versions = Project().versions()
        known = {"bios": "_".join(versions["SYSBIOS"]), "xdctools": "_".join(versions["XDCTOOLS"]) + "_core",
                 "C2000Ware": "_".join(versions["C2000WARE"])}
        for page in [*(REPOSITORY / "docs").rglob("*.md"), REPOSITORY / "README.md"]:
            for product, version in re.findall(r"\b(bios|xdctools|C2000Ware)_(\d[\w]*)", page.read_text(encoding="utf-8")):
                self.assertEqual(version, known[product], page.name)

    def test_what_ccs_shows_is_what_the_project_asks_for(self):
        page, properties = text(FLASHING), Project().properties
        for words in (properties["target"], properties["platform"], properties["buildProfile"], properties["xdcToolsVersion"],
                      *re.findall(r":([\d.]+)", properties["products"])):
            self.assertIn(words, page)

    def test_the_places_that_are_searched_are_named(self):
        source = text("tools/ti/roots.py")
        for place in ("/opt/ti", "/Applications/ti", "C:/ti"):
            self.assertIn(f'"{place}"', source)
            self.assertIn(f"`{place}`", text(FLASHING))

    def test_the_page_says_first_that_no_chip_has_seen_this(self):
        self.assertIn("TI's compiler and the board were not available", text(FLASHING).split("\n## ")[0])


class Links(unittest.TestCase):
    def test_every_link_leads_somewhere(self):
        for page in (HARDWARE, FLASHING):
            for target in re.findall(r"\]\(([^)#]+)(?:#[\w-]*)?\)", text(page)):
                self.assertTrue((REPOSITORY / "docs" / target).is_file(), f"{page}: {target}")

    def test_every_file_of_the_repository_that_is_named_exists(self):
        rooms = "ccs_project|firmware|bsp|drivers|control|tools|tests|cmake"
        for page in (HARDWARE, FLASHING):
            for path in re.findall(rf"`((?:{rooms})/[\w./]+)`", text(page)):
                self.assertTrue((REPOSITORY / path).exists(), f"{page}: {path}")


if __name__ == "__main__":
    unittest.main()
