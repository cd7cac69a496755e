# A thin facade: CMake builds, ctest tests, tools/setup/setup.sh installs what is missing.
.DEFAULT_GOAL := help
.NOTPARALLEL:
MAKEFLAGS += --no-print-directory
.PHONY: help build fly mine lab plot scan campaign fit tune verdict why noise seed-study ground ground-vehicle ground-open ground-fly site publish test test-long soak format ablate mutants test-ground port size faults fuzz prove rta bench coverage package others release firmware flash check-ti clean

setup := tools/setup/setup.sh
python := build/venv/bin/python -B
flights := pid-60cm-ramp est-60cm-ramp
# Where setup.sh puts CMock when it may not install packages; CMake falls back to the system's.
export CMOCK_ROOT ?= $(CURDIR)/build/cmock/usr/share/cmock
# As many jobs as processors, unless make was told how many.
jobs = $(if $(filter -j%,$(MAKEFLAGS)),,-j$(shell nproc))
ctest = python3 -B tests/run.py
# A new build tree is Ninja's where Ninja is installed; a tree that exists keeps what it was made with.
cmake = CMAKE_GENERATOR="$$(command -v ninja >/dev/null && echo Ninja || echo Unix Makefiles)" cmake -S .
# LOG is one file, whose name may have blanks, or several, which a pattern may name.
logs = if [ -e "$(LOG)" ]; then set -- "$(LOG)"; else set -- $(LOG); fi; \
    for log; do [ $$\# -eq 1 ] || [ -e "$$log" ] || \
        { echo "make $@: LOG: no file $$log. Where LOG names several files, none of them may have a blank in its name: rename it" >&2; exit 2; }; done
# FILE with its whole name; abspath would take a name with blanks for several. No FILE, no word.
file = $(if $(FILE),"$$(realpath -m -- "$(FILE)")")
# The two build trees of the tests. Both build everything once: test and test-long share them.
define build_tests
	@$(setup) build test campaign site
	@printf '\n== build with ASan and UBSan ==\n'
	@$(cmake) -B build-sanitize -DCMAKE_BUILD_TYPE=Debug -DSANITIZE=ON -DPLOMADA_TESTS=ON
	+@cmake --build build-sanitize $(jobs)
	@printf '\n== build as released ==\n'
	@$(cmake) -B build -DCMAKE_BUILD_TYPE=Release -DPLOMADA_TESTS=ON
	+@cmake --build build $(jobs)
endef

help: ## This list
	@sed -nE 's/^([a-z-]+):.*## (.*)/  make \1\t\2/p' $(MAKEFILE_LIST) | expand -t 23

build: ## The program build/plomada
	@$(setup) build
	@$(cmake) -B build -DCMAKE_BUILD_TYPE=Release $(if $(wildcard build/CMakeCache.txt),,-DPLOMADA_TESTS=OFF)
	+@cmake --build build --target plomada $(jobs)

fly: ## Fly the seed's 60 cm flight, by its own law and by the estimator's; CSV, JSON and pictures in build/
	@$(setup) build plot
	@$(MAKE) build
	@for flight in $(flights); do \
	    build/plomada fly $$flight --csv build/$$flight.csv --json build/$$flight.json || [ $$? -eq 1 ] || exit 2; \
	    $(python) tools/plot/plot.py build/$$flight.csv -o build/$$flight.png || exit 2; \
	    printf '%s\n' "$(CURDIR)/build/$$flight.csv" "$(CURDIR)/build/$$flight.json"; done
	@printf '\nBoth flights in one picture, and as one that moves (open it in a browser):\n'
	@$(python) tools/plot/plot.py $(flights:%=build/%.csv) -o build/fly.png
	@$(python) tools/plot/moving.py $(flights:%=build/%.csv) --title "PID, as the thesis flew it" \
	    --title "Law EST: an estimator and a cascade" -o build/fly.svg
	@grep -L '"met": true' $(flights:%=build/%.json) | sed 's/$$/: not as it must be/' | (! grep .)

mine: ## Fly a law of your own, FILE=examples/my_law/law_mine.c, beside law EST: docs/my_law.md; build-mine/plomada, pictures in build/
	@test -f "$(or $(FILE),examples/my_law/law_mine.c)" || { echo "make mine: no file $(FILE)" >&2; exit 2; }
	@$(setup) build plot
	@$(MAKE) build
	@$(cmake) -B build-mine -DCMAKE_BUILD_TYPE=Release -DPLOMADA_TESTS=OFF \
	    -DPLOMADA_LAW="$$(realpath -m -- "$(or $(FILE),examples/my_law/law_mine.c)")" >/dev/null
	+@cmake --build build-mine --target plomada $(jobs)
	@build-mine/plomada fly examples/my_law/mine.scenario --csv build/mine.csv --json build/mine.json
	@build/plomada fly est-60cm-ramp --csv build/est-60cm-ramp.csv --json build/est-60cm-ramp.json >/dev/null || [ $$? -eq 1 ]
	@$(python) tools/plot/plot.py build/mine.csv build/est-60cm-ramp.csv -o build/mine.png
	@$(python) tools/plot/moving.py build/mine.csv build/est-60cm-ramp.csv --title "Your law" --title "Law EST" -o build/mine.svg
	@echo "your law: $(or $(FILE),examples/my_law/law_mine.c)"

lab: ## Mark laboratory N=1 of the course (course/README.md): FILE=your answer, ID=your number
	@test -n "$(N)" || { echo "usage: make lab N=1 [ID=12345] [FILE=answer]" >&2; exit 2; }
	@$(setup) build lab
	@[ -x build/course_marker ] || echo 'make lab: builds the firmware once; that takes a minute or two' >&2
	@mkdir -p build && { $(MAKE) build && cmake --build build --target course_marker $(jobs); } >build/lab.log 2>&1 || { cat build/lab.log >&2; exit 2; }
	@python3 -B course/mark/lab.py $(N) $(if $(ID),--id "$(ID)") $(if $(FILE),--file "$(FILE)")

plot: ## Draw LOG=FILE and say what happened: a flight's CSV (or several), an XCTU console log or text, with or without dumps of #LOG
	@test -n "$(LOG)" || { echo "usage: make plot LOG=FILE" >&2; exit 2; }
	@$(setup) build plot
	@$(MAKE) build
	@$(logs); $(python) tools/plot/plot.py "$$@" -o build/

scan: ## Draw what a scanner saw: LOG=FILE of `plomada scip record`, a .logr of flexiport, or a DEVICE (ARGS=--help)
	@test -n "$(LOG)" || { echo "usage: make scan LOG=FILE|DEVICE" >&2; exit 2; }
	@$(setup) build plot
	@$(MAKE) build
	@$(logs); $(python) tools/plot/scan.py "$$@" -o build/ $(ARGS)

campaign: ## Fly every law on hundreds of vehicles; table, verdicts, CSV, JSON, picture in build/campaign/ (ARGS=--help)
	@$(setup) build campaign
	@$(MAKE) build
	@$(python) tools/campaign/campaign.py $(ARGS)

fit: ## Find the vehicle in LOG="a.csv b.csv", flights recorded by `#LOG RATE FAST` or fly --csv; build/vehicle.json (OUT=FILE)
	@test -n "$(LOG)" || { echo 'usage: make fit LOG="a.csv b.csv" [OUT=FILE]' >&2; exit 2; }
	@$(setup) build campaign
	@$(logs); $(python) tools/fit/fit.py "$$@" --out "$(or $(OUT),build/vehicle.json)" $(ARGS)

tune: ## Search the gains of LAW=EST on drawn vehicles, or on VEHICLE=build/vehicle.json with a forecast (ARGS=--help)
	@test -n "$(LAW)$(VEHICLE)" || { echo "usage: make tune LAW=NAME [ARGS=--help], or make tune VEHICLE=FILE [LAW=EST|PID]" >&2; exit 2; }
	@$(setup) build campaign
	@$(MAKE) build
	@$(python) $(if $(VEHICLE),tools/fit/tune_vehicle.py "$(VEHICLE)" --law $(or $(LAW),EST),tools/tune/tune.py $(LAW)) $(ARGS)

why: ## Why did it fly so? LOG=FILE of `plomada log`, fly --csv or --record, or a saved console; two sentences and build/why.png
	@test -n "$(LOG)" || { echo "usage: make why LOG=FILE [ARGS=--help]" >&2; exit 2; }
	@$(setup) build campaign
	@$(MAKE) build
	@build/plomada why "$(LOG)" $(ARGS)

verdict: ## Did the forecast of `make tune VEHICLE=` hold in LOG=next.csv? And what in the model was wrong
	@test -n "$(LOG)" || { echo "usage: make verdict LOG=next.csv" >&2; exit 2; }
	@$(setup) build campaign
	@$(logs); $(python) tools/fit/verdict.py "$$@" $(ARGS)

seed-study: ## Which autopilot did the seed fly? And its simulations of chapter 4.1; tables, CSV, picture in build/ (ARGS=--help)
	@$(setup) build campaign
	@$(MAKE) build
	@$(python) tools/seed_study/chapter_4_1.py -o build/chapter-4-1.png
	@$(python) tools/seed_study/seed_study.py $(ARGS)

noise: ## What the noises of the belief over three mirrors are worth on healthy flights; ARGS=--fit searches them (ARGS=--help)
	@$(setup) build campaign
	@$(MAKE) build
	@$(python) tools/noise/noise.py build/plomada $(ARGS)

ground: build ground-vehicle ## The browser page, to be published or opened as it is: build-ground/index.html
	@cd ground && npm run --silent build
	@printf '%s\n' "$(CURDIR)/build-ground/index.html"

ground-vehicle: ## The simulated vehicle as one WebAssembly module: build-ground/plomada.wasm, and vehicle.js for the page
	@test -z "$(FILE)" || test -f "$(FILE)" || { echo "make ground: no file $(FILE)" >&2; exit 2; }
	@$(setup) build plot ground
	@tools/ground/vehicle.sh $(file) >/dev/null
	@mkdir -p build-ground && cp build-wasm/plomada.wasm build-ground/
	@python3 -B tools/ground/vehicle_js.py build-ground/plomada.wasm build-ground/vehicle.js

ground-open: ground ## The same, served on this machine: http://localhost:8123 (FILE=a law of your own, docs/my_law.md)
	@python3 -B tools/ground/serve.py build-ground 8123

ground-fly: build ## A flight in a program of its own, for the page: ws://localhost:8124 (ARGS=hover-60s, or another scenario)
	@$(setup) bridge
	@$(python) tools/ground/bridge.py 8124 build/plomada fly $(or $(ARGS),hover-60s) --realtime

site: ## The pages as a site with a search: build-site/index.html
	@$(setup) site
	@NO_MKDOCS_2_WARNING=1 build/site-tools/bin/mkdocs --quiet build --strict --config-file tools/site/mkdocs.yml
	@printf '%s\n' "$(CURDIR)/build-site/index.html"

publish: ground ## The site with the browser page in it, to be put on a web server: build-site/
	@FLY=fly/index.html $(MAKE) site
	@rm -rf build-site/fly && cp -r build-ground build-site/fly

test-ground: ground ## The page's tests: units, then Chromium against the unmodified firmware; the vehicle in wasmtime
	@$(setup) bridge
	@$(python) -B tests/ground/test_vehicle.py build/plomada
	@$(python) -B tests/ground/test_bridge.py build/plomada
	@cd ground && npm test --silent

test: ## The tests, but for the long ones: under ASan and UBSan, then as released
	$(build_tests)
	@printf '\n== tests under ASan and UBSan ==\n'
	@$(ctest) build-sanitize -LE long
	@printf '\n== tests as released ==\n'
	@$(ctest) build -LE long
	@$(ctest) --spent 300 build-sanitize build

test-long: ## The long ones: sweeps of many flights, campaigns, tuning, fuzzing
	$(build_tests)
	@printf '\n== long tests under ASan and UBSan ==\n'
	@$(ctest) build-sanitize -L long -LE soak
	@printf '\n== long tests as released ==\n'
	@$(ctest) build -L long -LE soak

soak: ## The longest, nothing skipped: a board in real time, rates over drawn flights, planted causes, fits of 30 vehicles, proofs; an hour or two
	@$(setup) prove ground bridge
	$(build_tests)
	@NOTHING_SKIPPED=1 $(ctest) build -L soak

ablate: ## What is each part worth? Flights without it, against the same with it: ARGS="--part dips --lies 8 --seed 2"
	@$(setup) build campaign
	@$(python) -B tools/ablate/ablate.py $(ARGS)

mutants: ## Do the unit tests notice small faults? ARGS="--room control --sample 300 --seed 1"; survivors as a diff
	@$(setup) build test
	@python3 -B tools/mutants/mutants.py $(ARGS)

format: ## Every .c and .h file as .clang-format says; the test rule_format only looks
	@$(setup) test
	@python3 -B tests/rules/format.py --write

port: ## The unit tests of drivers/ and control/ also with 16-bit octets, 16-bit int and CHAR_BIT 16 (simulated)
	@$(setup) build test port
	@$(cmake) -B build-port -DCMAKE_BUILD_TYPE=Release -DPLOMADA_TESTS=ON -DPLOMADA_PORT=ON
	+@cmake --build build-port --target port $(jobs)
	@NOTHING_SKIPPED=1 $(ctest) build-port -L port; status=$$?; python3 -B tests/port/summary.py build-port && exit $$status

package: ## The scanner's driver for others: every compiler that must take it, PlatformIO; the ZIP is built in build-package/
	@$(setup) build test package
	@$(cmake) -B build-package -DCMAKE_BUILD_TYPE=Release -DPLOMADA_TESTS=ON -DPLOMADA_PACKAGE=ON
	+@cmake --build build-package --target plomada scanner_posix $(jobs)
	@NOTHING_SKIPPED=1 $(ctest) build-package -L package

others: ## urg_library's and hokuyoaist's programs, built from source, on the model of the sensor: what a URG-04LX can
	@$(setup) build test others
	@$(cmake) -B build-package -DCMAKE_BUILD_TYPE=Release -DPLOMADA_TESTS=ON -DPLOMADA_OTHERS=ON
	+@cmake --build build-package --target plomada $(jobs)
	@NOTHING_SKIPPED=1 $(ctest) build-package -L others

size: ## Flash, static RAM and stacks against the chip's limits, and docs/memory.md against them (ARGS=--write)
	@$(setup) size
	@python3 -B tools/size/size.py $(ARGS)

faults: ## The scanner's driver under FRAMES=10000000 damaged frames, and faults at every octet of its start
	@$(setup) build test
	@$(cmake) -B build -DCMAKE_BUILD_TYPE=Release -DPLOMADA_TESTS=ON
	+@cmake --build build --target scip_faults scip_start $(jobs)
	@build/tests/faults/scip_faults -n $(or $(FRAMES),10000000)
	@build/tests/faults/scip_start --faults

fuzz: ## The scanner's parser under libFuzzer for SECONDS=60; what breaks it stays in build/fuzz/
	@$(setup) build fuzz
	@tests/fuzz/fuzz.sh build/fuzz $(or $(SECONDS),60)

prove: ## No octet breaks the drivers: proofs by CBMC, minutes; docs/portability.md says what is proved (ARGS="razor")
	@$(setup) prove
	@python3 -B tests/prove/prove.py $(ARGS)

rta: ## Response-time analysis: does every task meet its deadline? (ARGS="plomada --bursts"; docs/realtime.md)
	@python3 -B tools/rta/rta.py $(or $(ARGS),plomada-est)

bench: ## Instructions of each step of the firmware (callgrind) against tools/bench/baseline.csv
	@$(setup) build bench
	@python3 -B tools/bench/bench.py $(ARGS)

coverage: ## Lines of drivers/ and control/, at least 95 %; lines and branches of the scanner's driver, all
	@$(setup) build test coverage
	@$(cmake) -B build-coverage -DCMAKE_BUILD_TYPE=Debug -DCOVERAGE=ON -DPLOMADA_TESTS=ON
	+@cmake --build build-coverage $(jobs)
	@find build-coverage -name '*.gcda' -delete
	@$(ctest) build-coverage
	@gcovr --root . --object-directory build-coverage --filter control/ --filter drivers/ --fail-under-line 95
	@gcovr --root . --object-directory build-coverage --filter drivers/scip_ --filter drivers/urg \
	    --fail-under-line 100 --fail-under-branch 100 --branches

release: build publish ## All that a release consists of, with sums, in build-release/, and what a person must still do (URL=https://...)
	@python3 -B tools/release/release.py $(if $(URL),--url $(URL))

firmware: ## The target image, by TI's tools without CCS: docs/flashing.md
	@python3 -B tools/ti/firmware.py

flash: ## Put it on the LaunchPad, by the XDS100v2 on its USB
	@python3 -B tools/ti/flash.py

check-ti: ## The target sources and sim/'s stand-ins against TI's headers; an error: a root is missing
	@python3 -B tools/ti/check_ti.py

clean: ## Remove everything that was built, the Python environment included
	rm -rf build build-* ground/node_modules
