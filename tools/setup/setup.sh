#!/usr/bin/env bash
# setup.sh build|lab|test|port|size|coverage|bench|fuzz|prove|package|others|plot|campaign|bridge|ground|site ...: installs what the named jobs need and the machine lacks (Debian 12 or later).
#
#   build     C compiler, CMake
#   lab       Python 3 for the marks of the course
#   test      Ninja (a third of make's processor time); Ruby and CMock, which generates the mocks; Python 3 for the checks of the house rules; build/format with the
#             pinned clang-format
#   port      avr-gcc, its C library, and simavr to run what it makes
#   size      m68k-linux-gnu-gcc and avr-gcc, which measure; their C libraries
#   coverage  gcovr
#   bench     valgrind
#   fuzz      clang and its libFuzzer
#   prove     CBMC and a C preprocessor; build/cbmc where Debian's suite has no CBMC
#   package   compilers for other machines: clang, avr-gcc, arm-none-eabi-gcc, MinGW-w64; build/pio with the pinned PlatformIO
#   others    sources of urg_library, hokuyoaist and flexiport in build/others, at the commits of tools/setup/others.txt
#   plot      Python virtual environment build/venv with the packages of tools/plot/requirements.txt
#   campaign  the same, and in it those of tools/campaign/requirements.txt; for tuning too, and for some tests
#   bridge    the virtual environment of plot, and in it the packages of tools/ground/requirements.txt: a flight for the page
#   ground    clang, lld, wasi-libc and binaryen for the vehicle in the browser; wasmtime in build/venv; node and the pinned
#             packages of ground/package-lock.json; Chromium and Firefox for its tests
#   site      Python virtual environment build/site-tools with the packages of tools/site/requirements.txt
#
# Packages of Python and of node are those whose sums stand in requirements.txt (tools/setup/pin.sh) and package-lock.json, no others.
#
# Non-interactive and idempotent: silent, and no call of apt or pip, when nothing is missing. Packages are installed
# as root, or by sudo where the user may use it; otherwise one line says what to install, and the status is 1.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(cd "$here/../.." && pwd)
venv=$root/build/venv
requirements=$root/tools/plot/requirements.txt
campaign_requirements=$root/tools/campaign/requirements.txt
ground_requirements=$root/ground/requirements.txt
bridge_requirements=$root/tools/ground/requirements.txt
cmock_private=$root/build/cmock
format=$root/build/format
format_requirements=$root/tools/format/requirements.txt
site=$root/build/site-tools
site_requirements=$root/tools/site/requirements.txt
pio=$root/build/pio
others=$root/build/others
pio_requirements=$root/tools/scip_package/requirements.txt

say() { printf 'setup: %s\n' "$*" >&2; }
die() { say "$*"; exit 1; }
has() { command -v "$1" >/dev/null 2>&1; }
cmock_in() { [ -f "$1/lib/cmock.rb" ] && [ -f "$1/vendor/unity/src/unity.c" ]; }

cmock_ready() {
    cmock_in /usr/share/cmock || cmock_in "$cmock_private/usr/share/cmock" || cmock_in "${CMOCK_ROOT:-/nowhere}"
}

# Prints a Python that can make virtual environments: Debian's, or the first on PATH.
venv_maker() {
    local python
    for python in /usr/bin/python3 python3; do
        if has "$python" && "$python" -c 'import sys, venv, ensurepip; sys.exit(sys.version_info < (3, 11))' 2>/dev/null; then
            echo "$python"
            return 0
        fi
    done
    return 1
}

venv_ready() {
    [ -x "$venv/bin/python" ] && cmp -s "$requirements" "$venv/requirements.txt" &&
        "$venv/bin/python" -c 'import sys, importlib.util as u; sys.exit(u.find_spec("matplotlib") is None)' 2>/dev/null
}

format_ready() { [ -x "$format/bin/clang-format" ] && cmp -s "$format_requirements" "$format/requirements.txt"; }

site_ready() { [ -x "$site/bin/mkdocs" ] && cmp -s "$site_requirements" "$site/requirements.txt"; }
others_ready() {
    local name commit address
    while read -r name commit address; do
        [ "$(git --git-dir="$others/$name/.git" rev-parse HEAD 2>/dev/null)" = "$commit" ] || return 1
    done < <(grep -v '^#' "$here/others.txt")
}

pio_ready() { [ -x "$pio/bin/pio" ] && cmp -s "$pio_requirements" "$pio/requirements.txt"; }

campaign_ready() { venv_ready && cmp -s "$campaign_requirements" "$venv/campaign.txt"; }

bridge_ready() { venv_ready && cmp -s "$bridge_requirements" "$venv/bridge.txt"; }
ground_ready() { venv_ready && cmp -s "$ground_requirements" "$venv/ground.txt"; }
modules_ready() { cmp -s "$root/ground/package-lock.json" "$root/ground/node_modules/.installed-lock.json"; }

# A clang that makes WebAssembly, with its linker and run-time library.
wasm_ready() {
    local clang
    for clang in clang-{14..30} clang; do
        if has "$clang" && has "${clang/clang/wasm-ld}" &&
            [ -n "$(find "$("$clang" -print-resource-dir)/lib" -name 'libclang_rt.builtins*wasm32*' -print -quit 2>/dev/null)" ]; then
            return 0
        fi
    done
    return 1
}

wasm_packages() {
    local version
    version=$(apt-cache depends clang 2>/dev/null | sed -n 's/^ *Depends: clang-\([0-9]*\)$/\1/p') || true
    echo "clang-${version:-14} lld-${version:-14} libclang-rt-${version:-14}-dev-wasm32"
}

node_ready() { has node && node -e 'process.exit(parseInt(process.versions.node) < 18 ? 1 : 0)' 2>/dev/null; }

cbmc_ready() { has cbmc || [ -x "$root/build/cbmc/cbmc" ]; }

any_clang() {
    local clang
    for clang in clang clang-{14..30}; do
        if has "$clang"; then return 0; fi
    done
    return 1
}

# A clang that has libFuzzer.
fuzzer_ready() {
    local clang
    for clang in clang clang-{14..30}; do
        if has "$clang" && [ -n "$(find "$("$clang" -print-resource-dir)/" -name 'libclang_rt.fuzzer*' -print -quit)" ]; then
            return 0
        fi
    done
    return 1
}

fuzzer_packages() {
    local version
    version=$(apt-cache depends clang 2>/dev/null | sed -n 's/^ *Depends: clang-\([0-9]*\)$/\1/p') || true
    echo "clang-${version:-14} libclang-rt-${version:-14}-dev"
}

# Whether a compiler finds a header.
finds() { "$1" -E -x c -include "$2" /dev/null >/dev/null 2>&1; }

avr_packages() {
    has avr-gcc || echo gcc-avr
    finds avr-gcc stdio.h || echo avr-libc
}

# Debian packages that the job lacks; cmock is treated apart.
missing_packages() {
    case $1 in
        build)
            has gcc || has cc || has "${CC:-cc}" || echo gcc
            [ -f /usr/include/stdio.h ] || echo libc6-dev
            has cmake || echo cmake ;;
        lab)
            has python3 || echo python3 ;;
        test)
            has ninja || ! has apt-get || ! elevation >/dev/null || echo ninja-build # only faster than make: not worth a failure
            has ruby || echo ruby
            has python3 || echo python3
            format_ready || venv_maker >/dev/null || echo python3-venv ;;
        port)
            has python3 || echo python3
            avr_packages
            finds gcc simavr/sim_avr.h || echo libsimavr-dev ;;
        size)
            has python3 || echo python3
            avr_packages
            has m68k-linux-gnu-gcc || echo gcc-m68k-linux-gnu
            finds m68k-linux-gnu-gcc math.h || echo libc6-dev-m68k-cross ;;
        coverage)
            has gcovr || echo gcovr ;;
        bench)
            has python3 || echo python3
            has valgrind || echo valgrind ;;
        fuzz)
            fuzzer_ready || fuzzer_packages ;;
        prove)
            has python3 || echo python3
            has gcc || echo gcc
            cbmc_ready || ! known cbmc || echo cbmc ;;
        package)
            has gcc || echo gcc
            has g++ || echo g++
            any_clang || echo clang
            avr_packages
            has arm-none-eabi-gcc || echo gcc-arm-none-eabi
            finds arm-none-eabi-gcc string.h || echo libnewlib-arm-none-eabi
            has x86_64-w64-mingw32-gcc || echo gcc-mingw-w64-x86-64-win32
            pio_ready || venv_maker >/dev/null || echo python3-venv ;;
        others)
            has g++ || echo g++
            has git || echo git ;;
        plot|campaign|bridge)
            venv_ready || venv_maker >/dev/null || echo python3-venv ;;
        site)
            site_ready || venv_maker >/dev/null || echo python3-venv ;;
        ground)
            wasm_ready || wasm_packages
            [ -f /usr/include/wasm32-wasi/stdio.h ] || echo wasi-libc
            has wasm-opt || echo binaryen
            node_ready || echo nodejs
            has npm || echo npm
            has chromium || echo chromium
            has firefox || has firefox-esr || ! grep -qs '^ID=debian' /etc/os-release || echo firefox-esr
            venv_ready || venv_maker >/dev/null || echo python3-venv ;;
        *)
            say "unknown job '$1'; know build, lab, test, port, size, coverage, bench, fuzz, prove, package, others, plot, campaign, bridge, ground, site"
            exit 2 ;;
    esac
}

# How to run apt as root: empty for root, "sudo", or failure.
elevation() {
    [ "$(id -u)" -ne 0 ] || return 0
    if has sudo && { sudo -n true 2>/dev/null || { [ -t 0 ] && id -nG | grep -qwE 'sudo|wheel|admin'; }; }; then
        echo sudo
    else
        return 1
    fi
}

known() { [ -n "$(apt-cache show --no-all-versions "$1" 2>/dev/null)" ]; }

as_root() {
    if [ -n "$sudo" ]; then sudo "$@"; else "$@"; fi
}

apt_get() {
    as_root env DEBIAN_FRONTEND=noninteractive apt-get -qq -y -o DPkg::Lock::Timeout=300 -o Dpkg::Use-Pty=0 "$@"
}

update_lists() {
    say "reading the package lists"
    apt_get update
    updated=yes
}

# One apt-get call for everything; the package lists are read first only when they do not know a name.
install_packages() {
    local wanted=("$@") package updated=
    for package in "${wanted[@]}" ${want_cmock:+ruby}; do
        if ! known "$package"; then
            update_lists
            break
        fi
    done
    if [ -n "$want_cmock" ]; then
        if known cmock; then
            wanted+=(cmock)
        else
            scratch=$(mktemp -d)
            trap 'rm -rf "$scratch"' EXIT
            package=$("$here/fetch_trixie.sh" "$scratch" cmock)
            wanted+=("$package")
        fi
    fi
    say "installing ${wanted[*]##*/}"
    if ! apt_get install --no-install-recommends "${wanted[@]}" >&2; then
        [ -z "$updated" ] || return 1
        update_lists
        apt_get install --no-install-recommends "${wanted[@]}" >&2
    fi
}

# own_venv FOLDER REQUIREMENTS: a virtual environment for these packages alone.
own_venv() {
    local python
    python=$(venv_maker) || die "no Python 3.11 or later that can make a virtual environment: apt-get install python3-venv"
    say "making ${1#"$root/"} with the packages of ${2#"$root/"}"
    rm -rf "$1"
    mkdir -p "$root/build"
    "$python" -m venv "$1"
    pip_install "$1" "$2" || die "pip could not install ${2#"$root/"} (see above)"
    cp "$2" "$1/requirements.txt"
}

fetch_others() {
    local name commit address
    while read -r name commit address; do
        say "fetching $name"
        rm -rf "${others:?}/$name"
        git clone --quiet "$address" "$others/$name" && git -C "$others/$name" -c advice.detachedHead=false checkout --quiet "$commit" ||
            die "git could not fetch $name (see above)"
    done < <(grep -v '^#' "$here/others.txt")
}

# A virtual environment and a requirements.txt.
pip_install() { "$1/bin/python" -m pip --quiet --disable-pip-version-check install --only-binary :all: --require-hashes -r "$2"; }

add_campaign() {
    say "adding the packages of tools/campaign/requirements.txt to build/venv"
    pip_install "$venv" "$campaign_requirements" ||
        die "pip could not install tools/campaign/requirements.txt (see above)"
    cp "$campaign_requirements" "$venv/campaign.txt"
}

add_bridge() {
    say "adding the packages of tools/ground/requirements.txt to build/venv"
    pip_install "$venv" "$bridge_requirements" || die "pip could not install tools/ground/requirements.txt (see above)"
    cp "$bridge_requirements" "$venv/bridge.txt"
}

add_ground() {
    say "adding the packages of ground/requirements.txt to build/venv"
    pip_install "$venv" "$ground_requirements" || die "pip could not install ground/requirements.txt (see above)"
    cp "$ground_requirements" "$venv/ground.txt"
}

add_modules() {
    say "installing the packages of ground/package-lock.json in ground/node_modules"
    (cd "$root/ground" && npm ci --ignore-scripts --silent --no-audit --no-fund) >&2 || die "npm could not install them (see above)"
    cp "$root/ground/package-lock.json" "$root/ground/node_modules/.installed-lock.json"
}

[ $# -gt 0 ] || { say "usage: setup.sh build|lab|test|port|size|coverage|bench|fuzz|prove|package|others|plot|campaign|bridge|ground|site ..."; exit 2; }

packages=()
want_cmock=
want_venv=
want_cbmc=
want_campaign=
want_bridge=
want_ground=
want_modules=
want_format=
want_pio=
want_others=
want_site=
for job in "$@"; do
    list=$(missing_packages "$job")
    for package in $list; do packages+=("$package"); done
    case $job in
        test)
            cmock_ready || want_cmock=yes
            format_ready || want_format=yes ;;
        package) pio_ready || want_pio=yes ;;
        others) others_ready || want_others=yes ;;
        prove) cbmc_ready || known cbmc || want_cbmc=yes ;;
        plot) venv_ready || want_venv=yes ;;
        site) site_ready || want_site=yes ;;
        campaign)
            venv_ready || want_venv=yes
            campaign_ready || want_campaign=yes ;;
        bridge)
            venv_ready || want_venv=yes
            bridge_ready || want_bridge=yes ;;
        ground)
            venv_ready || want_venv=yes
            ground_ready || want_ground=yes
            modules_ready || want_modules=yes ;;
    esac
done

if [ ${#packages[@]} -gt 0 ] || [ -n "$want_cmock" ]; then
    has apt-get || die "no apt-get here; install: ${packages[*]} ${want_cmock:+cmock}"
    if sudo=$(elevation); then
        install_packages ${packages[@]+"${packages[@]}"}
    elif [ ${#packages[@]} -gt 0 ]; then
        die "not root and no sudo; first run as root: apt-get install -y --no-install-recommends ${packages[*]}"
    else
        say "not root: CMock goes to build/cmock"
        mkdir -p "$cmock_private"
        package=$("$here/fetch_trixie.sh" "$cmock_private" cmock)
        dpkg-deb -x "$package" "$cmock_private"
    fi
fi
[ -z "$want_cbmc" ] || "$here/unpack_cbmc.sh" "$root/build/cbmc"
[ -z "$want_venv" ] || own_venv "$venv" "$requirements"
[ -z "$want_campaign" ] || add_campaign
[ -z "$want_bridge" ] || add_bridge
[ -z "$want_ground" ] || add_ground
[ -z "$want_modules" ] || add_modules
[ -z "$want_format" ] || own_venv "$format" "$format_requirements"
[ -z "$want_pio" ] || own_venv "$pio" "$pio_requirements"
[ -z "$want_others" ] || fetch_others
[ -z "$want_site" ] || own_venv "$site" "$site_requirements"
