# shellcheck shell=bash
# Sourced by run.sh and test.sh: installs what is missing, and says so.

# A compiler, NetCDF and HDF5, Python. Sets `cargo_flags`: empty where the libraries are on
# the system, otherwise the feature that builds them from source.
# shellcheck disable=SC2034 # cargo_flags is read by the scripts that source this file
prepare_system() {
    if ! command -v cargo >/dev/null && [ -f "$HOME/.cargo/env" ]; then
        # shellcheck source=/dev/null
        . "$HOME/.cargo/env"
    fi
    command -v cargo >/dev/null || fail "no cargo here; install Rust first: https://rustup.rs"

    cargo_flags=()
    local tools=() libraries=()
    command -v cc >/dev/null || tools+=(gcc libc6-dev)
    python3 -c 'import ensurepip, venv' 2>/dev/null || tools+=(python3-venv)
    command -v pkg-config >/dev/null || libraries+=(pkg-config)
    has_library netcdf || libraries+=(libnetcdf-dev)
    has_library hdf5 || libraries+=(libhdf5-dev)
    local missing=("${tools[@]}" "${libraries[@]}")
    [ ${#missing[@]} -gt 0 ] || return 0

    if command -v apt-get >/dev/null; then
        echo "Installing with apt: ${missing[*]}"
        apt_install "${missing[@]}"
    elif [ ${#tools[@]} -eq 0 ] && has_cmake; then
        echo "There is no apt to install ${libraries[*]} (Debian's names) with."
        echo "Building NetCDF and HDF5 from source: this takes some minutes, once."
        cargo_flags=(--features experiments/static)
    else
        fail "missing: ${missing[*]} (Debian's names), and there is no apt. Install them with" \
            "your package manager. Without NetCDF and HDF5, a C compiler and cmake 3.26 or" \
            "newer do too: both are then built from source (the feature \`static\`)."
    fi
}

# Vulkan, for the tests of the GPU: in software, where no graphics driver is installed. Without
# it they are skipped, and everything else works.
prepare_vulkan() {
    [ "$(uname)" = Linux ] || return 0
    # Mesa asks a display which device it prefers, and complains aloud where there is none.
    export NODEVICE_SELECT=1
    local missing=()
    # Users may not have the folder of ldconfig in their path.
    PATH="$PATH:/sbin:/usr/sbin" ldconfig -p | grep 'libvulkan\.so\.1' >/dev/null ||
        missing+=(libvulkan1)
    compgen -G '/usr/share/vulkan/icd.d/*.json' >/dev/null ||
        compgen -G '/etc/vulkan/icd.d/*.json' >/dev/null || missing+=(mesa-vulkan-drivers)
    [ ${#missing[@]} -gt 0 ] || return 0

    if command -v apt-get >/dev/null && can_be_root; then
        echo "Installing with apt: ${missing[*]}"
        apt_install "${missing[@]}" && return 0
    fi
    echo "Not here, and not installed: ${missing[*]} (Debian's names). Tests of the GPU are skipped."
}

# The Python of the tests and figures, in .venv.
prepare_python() {
    local wanted=tests/python/requirements.txt
    if cmp -s "$wanted" .venv/installed.txt; then
        return
    fi
    echo "Installing into .venv: $(sed -n 's/==.*//p' "$wanted" | sort -u | paste -sd ' ')"
    python3 -m venv --clear .venv
    .venv/bin/pip install --quiet --disable-pip-version-check --requirement "$wanted"
    cp "$wanted" .venv/installed.txt
}

has_library() {
    command -v pkg-config >/dev/null && pkg-config --exists "$1"
}

# HDF5's own build asks for 3.26.
has_cmake() {
    command -v cmake >/dev/null && printf '3.26\n%s\n' "$(cmake --version | awk 'NR == 1 {print $3}')" | sort -VC
}

apt_install() {
    as_root apt-get update -qq &&
        as_root env DEBIAN_FRONTEND=noninteractive \
            apt-get install -y -qq --no-install-recommends "$@"
}

can_be_root() {
    [ "$(id -u)" -eq 0 ] || command -v sudo >/dev/null
}

as_root() {
    if [ "$(id -u)" -eq 0 ]; then
        "$@"
    elif command -v sudo >/dev/null; then
        sudo "$@"
    else
        fail "not root, and no sudo; run as root: $*"
    fi
}

fail() {
    echo "error: $*" >&2
    exit 1
}
