"""ccs_project/plomada.cmd fits the TMS320F28377S and has the names that SYS/BIOS's generated linker file refers to."""
import re
import unittest

from here import code, product_files

# ti/catalog/c2800/initF2837x/linkcmd.xdt and the platform's linkcmd.xdt, with app.cfg's Boot defaults.
GENERATED_NAMES = {"BEGIN": 0, "FLASHA": 0, "D01SARAM": 0}
# Of the chip, first and last word: M0 and M1, LS0 to LS5, D0 and D1, GS0 to GS15, flash bank 0, reset vector.
CHIP = [(0x000000, 0x0007FF), (0x008000, 0x00AFFF), (0x00B000, 0x00BFFF), (0x00C000, 0x01BFFF), (0x080000, 0x0BFFFF),
        (0x3FFFC0, 0x3FFFC1)]
BOOT_ROM_STACK_END = 0x122
STACK_LIMIT = 0x10000
SECTIONS_OF_COFF = {".text", ".cinit", ".binit", ".pinit", ".econst", ".switch", ".args", ".reset", ".TI.ramfunc", ".stack",
                    ".ebss", ".ebss:taskStackSection", ".esysmem", ".cio", ".data", "codestart"}


class Memory(unittest.TestCase):
    def setUp(self):
        content = code("ccs_project/plomada.cmd")
        memory, sections, self.symbols = re.fullmatch(
            r"\s*MEMORY\s*\{(.*)\}\s*SECTIONS\s*\{(.*)\}\s*(.*)", content, re.DOTALL).groups()
        self.regions = {}
        for page, body in re.findall(r"PAGE (\d):(.*?)(?=PAGE \d:|\Z)", memory, re.DOTALL):
            for name, origin, length in re.findall(r"(\w+)\s*: origin = (0x[0-9A-F]+), length = (0x[0-9A-F]+)", body):
                self.assertNotIn(name, self.regions)
                self.regions[name] = (int(page), int(origin, 16), int(origin, 16) + int(length, 16) - 1)
        self.sections = {name: " ".join(place.split()) for name, place in re.findall(
            r"^\s*([.\w]+(?::\w+)?)\s*: (.+?)(?=^\s*[.\w]+(?::\w+)?\s*: |\Z)", sections, re.MULTILINE | re.DOTALL)}

    def where(self, section):
        return [name for name in re.findall(r"\w+", self.sections[section]) if name in self.regions]

    def test_it_has_the_names_that_the_kernels_linker_file_refers_to(self):
        for name, page in GENERATED_NAMES.items():
            self.assertEqual(self.regions[name][0], page, name)
        self.assertEqual(self.regions["BEGIN"][1:], (0x80000, 0x80001), "the boot ROM jumps there")

    def test_regions_lie_in_the_chip_and_apart_from_each_other(self):
        spans = sorted(span[1:] for span in self.regions.values())
        for first, last in spans:
            self.assertTrue(any(low <= first and last <= high for low, high in CHIP), hex(first))
        for (_, last), (first, _) in zip(spans, spans[1:]):
            self.assertLess(last, first)

    def test_words_that_the_errata_and_the_boot_rom_want_free_are_free(self):
        for name, (_, first, last) in self.regions.items():
            self.assertFalse(first <= 0x7FF and last >= 0x7F8, f"{name}: last 8 words of M1")
            self.assertFalse(first <= 0xBFFFF and last >= 0xBFFF0, f"{name}: last 16 words of the flash bank")
            self.assertTrue(name == "BOOT_RSVD" or last < 2 or first >= BOOT_ROM_STACK_END, name)

    def test_every_stack_is_in_reach_of_the_stack_pointer(self):
        for section in (".stack", ".ebss:taskStackSection"):
            (name,) = self.where(section)
            page, _, last = self.regions[name]
            self.assertEqual(page, 1)
            self.assertLess(last, STACK_LIMIT)

    def test_variables_lie_in_one_piece_that_the_start_up_sets_to_zero(self):
        self.assertEqual(len(self.where(".ebss")), 1)
        self.assertNotIn(">>", self.sections[".ebss"])
        self.assertIn("START(_ebss_start), SIZE(_ebss_size)", self.sections[".ebss"])
        self.assertIn("Reset.fxns.$add('&bsp_start');", code("ccs_project/app.cfg"))
        self.assertRegex(code("bsp/start.c"), r"\bvoid bsp_start\(void\)")

    def test_what_outlives_a_reset_is_apart_from_what_is_set_to_zero(self):
        self.assertNotEqual(self.where(".retained"), self.where(".ebss"))

    def test_the_flash_library_runs_from_ram_because_it_takes_the_bank_away(self):
        for part in (".text", ".econst"):
            self.assertIn(f"-l F021_API_F2837xS_FPU32.lib ({part})", self.sections[".TI.ramfunc"])

    def test_what_handles_the_flash_runs_from_ram(self):
        storage = code("bsp/storage.c")
        own = set(re.findall(r"^(?!extern)(?:static )?\w[\w ]*?\b(\w+)\([^;{]*\)\n\{", storage, re.MULTILINE))
        driverlibs = set(re.findall(r"\b((?:Flash|SysCtl)_\w+)\(", storage))
        in_ram = set(re.findall(r'CODE_SECTION\((\w+), "\.TI\.ramfunc"\)', storage))
        self.assertGreater(len(own), 8)
        # driverlib's flash.h places this one itself, and no other that is used here.
        self.assertEqual(own | driverlibs - {"Flash_enableECC"}, in_ram)
        for path in product_files(".c"):
            if path != "bsp/storage.c":
                self.assertNotRegex(code(path), r"\b(?:Flash|Fapi)_", path)

    def test_the_lines_that_replace_others_are_code_in_the_bank_that_is_started(self):
        self.assertIn("START(_flash_code)", self.sections[".text"])
        region, = self.where(".text")
        self.assertGreaterEqual(self.regions[region][1], 0x80000)
        self.assertLessEqual(self.regions[region][2], 0xBFFFF)

    def test_constants_begin_in_the_sector_that_the_code_does_not_use(self):
        self.assertIn(">> FLASHA | FLASH", self.sections[".econst"])
        self.assertNotIn("FLASHA", re.findall(r"\w+", self.sections[".text"]))

    def test_every_section_has_a_place_on_the_page_that_it_names(self):
        own = {name for path in product_files(".c")
               for name in re.findall(r'(?:DATA_SECTION\(\w+, |CODE_SECTION\(\w+, |section\()"([.\w:]+)"', code(path))}
        self.assertEqual(set(self.sections), SECTIONS_OF_COFF | own)
        for section, place in self.sections.items():
            names = self.where(section)
            self.assertTrue(names, section)
            self.assertIn("PAGE", place)
            for name in names:
                self.assertEqual(self.regions[name][0], int(re.search(r"PAGE = (\d)", place).group(1)), section)

    def test_what_must_run_from_ram_is_copied_there_by_the_start_up_code(self):
        place = self.sections[".TI.ramfunc"]
        self.assertIn("table(BINIT)", place)
        self.assertIn("*(.TI.ramfunc)", place)
        load, run = re.search(r"LOAD = (\w+), RUN = (\w+)", place).groups()
        self.assertGreaterEqual(self.regions[load][1], 0x80000)
        self.assertLess(self.regions[run][2], 0x80000)

    def test_what_the_sources_expect_of_the_linker_file_is_there_and_overlaps_nothing(self):
        symbols = {name: int(address, 16) for name, address in re.findall(r"^_(\w+) = (0x[0-9A-F]+);$", self.symbols, re.MULTILINE)}
        made = set(re.findall(r"\b(?:START|SIZE)\(_(\w+)\)", " ".join(self.sections.values())))
        expected = {name for path in product_files(".c")
                    for name in re.findall(r"^extern [^;(]*?\b(\w+)\s*(?:\[[^;]*)?;", code(path), re.MULTILINE)}
        self.assertEqual(expected - set(symbols) - made, set())
        for name, address in symbols.items():
            self.assertTrue(any(low <= address <= high for low, high in CHIP), name)
            self.assertFalse(any(first <= address <= last for _, first, last in self.regions.values()), name)

    def test_stack_and_heap_of_app_cfg_fit(self):
        cfg = code("ccs_project/app.cfg")
        for setting, section in (("Program.stack", ".stack"), ("BIOS.heapSize", ".ebss:taskStackSection")):
            words = int(re.search(rf"{re.escape(setting)}\s*= (0x[0-9A-Fa-f]+);", cfg).group(1), 16)
            largest = max(self.regions[name][2] - self.regions[name][1] + 1 for name in self.where(section))
            self.assertLessEqual(words, largest, setting)


if __name__ == "__main__":
    unittest.main()
