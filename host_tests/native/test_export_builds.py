"""What is exported builds as C99 and C++, for Arduino, ESP-IDF and Zephyr, as far as stubs show.

The builders' own packages are in no registry that a test may use: the sketch is compiled against
a stub of Arduino, and the build file is run by CMake with stubs of ESP-IDF's and Zephyr's commands.
What the subset of kernels lacks is refused with its row. (What it has, bits of kernels show.)
"""

import json
import re
import shutil
import subprocess
from pathlib import Path

import pytest
from zerorate_tools import __version__
from zerorate_tools.cli import main
from zerorate_tools.kernels.c_functions import kernels_in_c
from zerorate_tools.kernels.reading import Kernels, NotKernel

STRICT = ["-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Werror"]
LANGUAGES = {"c99": ["-x", "c", "-std=c99"], "c++": ["-x", "c++", "-std=c++11"]}
USER = """\
#include "zerorate_units.h"
#include <stdio.h>
#if ZERORATE_VERSION_MAJOR < 0
#error
#endif
static zerorate_t z;
int main(void) {
    float left = 0.0f;
    zerorate_begin(&z);
    for (int32_t n = 0; n < 6000; n++) {
        float gyro[3] = {1.5f, -0.25f, 0.5f}, accel[3] = {0.0f, 0.0f, 1.0f};
        for (int i = 0; i < 3; i++) gyro[i] += (float)(n * 7919 % 13 - 6) / 131.0f;
        accel[0] += (float)(n * 104729 % 11 - 5) / 4000.0f;
        zerorate_update_dps(&z, gyro, accel, 25.0f + (float)(n % 3) / 340.0f, 0.01f);
        if (n >= 5000) left += gyro[0] / 1000.0f;
    }
    printf("%s %d %.4f %.4f %.4f\\n", ZERORATE_VERSION, (int)zerorate_learned(&z),
           (double)zerorate_bias_dps(&z, 0), (double)zerorate_quality_dps(&z, 0), (double)left);
    volatile float long_s = 5000.0f;
    float gyro[3] = {1.0f, 0.0f, 0.0f}, accel[3] = {0.0f, 0.0f, 1.0f};
    printf("%d\\n", (int)zerorate_update_dps(&z, gyro, accel, 25.0f, long_s));
    return 0;
}
"""


def needs(*programs):
    """Skip a test where one of the programs is missing."""
    missing = [name for name in programs if not shutil.which(name)]
    return pytest.mark.skipif(bool(missing), reason=f"no {' '.join(missing)} here")


@pytest.fixture(scope="module")
def exported(tmp_path_factory):
    folder = tmp_path_factory.mktemp("export") / "zerorate"
    assert main(["export", "c", str(folder)]) == 0
    return folder


def built(compiler, *arguments, cwd):
    subprocess.run([compiler, *STRICT, "-O1", *map(str, arguments)], check=True, cwd=cwd)


@needs("cc", "g++")
@pytest.mark.parametrize("language", LANGUAGES)
def test_rates_in_degrees_lose_their_bias_and_nothing_warns(exported, tmp_path, language):
    (tmp_path / "user.c").write_text(USER)
    compiler = "g++" if language == "c++" else "cc"
    sources = [exported / "zerorate.c", tmp_path / "user.c"]
    built(compiler, *LANGUAGES[language], "-I", exported, *sources, "-o", "user", cwd=tmp_path)
    said = subprocess.run([tmp_path / "user"], check=True, capture_output=True, text=True).stdout
    version, learned, bias, quality, left, verdict = said.split()
    assert (version, learned, verdict) == (__version__, "1", "7")  # 7: the time leapt
    assert float(bias) == pytest.approx(1.5, abs=0.01)
    assert 0 < float(quality) < 0.02
    assert float(left) == pytest.approx(0, abs=0.01)


@needs("g++")
def test_the_sketch_prints_yaw_with_and_without(exported, tmp_path):
    sketch = exported / "examples" / "yaw" / "yaw.ino"
    stub = Path(__file__).with_name("arduino_stub.h")
    (tmp_path / "Wire.h").write_text("")
    built("cc", "-c", exported / "zerorate.c", cwd=tmp_path)
    sources = ["-include", stub, "-x", "c++", "-std=c++11", sketch, "-x", "none", "zerorate.o"]
    built("g++", "-I", exported, "-I", ".", *sources, "-o", "yaw", cwd=tmp_path)
    said = subprocess.run([tmp_path / "yaw"], check=True, capture_output=True, text=True).stdout
    lines = re.findall(r"yaw without (\S+)  with (\S+) deg(.*)", said)
    assert len(lines) > 50 and "nothing is learned" in lines[0][2] and lines[-1][2] == ""
    without, corrected = (float(number) for number in lines[-1][:2])
    assert without == pytest.approx(2 * 60, rel=0.05)  # 2 dps of bias for a minute
    assert abs(corrected) < 1.0


ESP = """\
cmake_minimum_required(VERSION 3.10)
project(firmware C)
set(ESP_PLATFORM 1)
function(idf_component_register)
  cmake_parse_arguments(A "" "" "SRCS;INCLUDE_DIRS" ${ARGN})
  add_library(component ${A_SRCS})
  target_include_directories(component PUBLIC ${A_INCLUDE_DIRS})
endfunction()
add_subdirectory(zerorate)
"""
ZEPHYR = """\
cmake_minimum_required(VERSION 3.10)
project(firmware C)
set(CONFIG_ZERORATE y)
macro(zephyr_library)
  add_library(component STATIC)
endmacro()
macro(zephyr_library_sources)
  target_sources(component PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/${ARGN})
endmacro()
macro(zephyr_include_directories)
  target_include_directories(component PUBLIC ${ARGN})
endmacro()
add_subdirectory(zerorate)
"""


@needs("cmake", "cc")
@pytest.mark.parametrize("project", [ESP, ZEPHYR], ids=["esp-idf", "zephyr"])
def test_the_build_file_makes_a_library_of_it(exported, tmp_path, project):
    shutil.copytree(exported, tmp_path / "zerorate")
    (tmp_path / "CMakeLists.txt").write_text(project)
    for command in (["cmake", "-S", ".", "-B", "build"], ["cmake", "--build", "build"]):
        subprocess.run(command, check=True, cwd=tmp_path, capture_output=True)
    assert list((tmp_path / "build").rglob("libcomponent.a"))


def test_what_describes_it_has_its_version_and_names_files_that_are_there(exported):
    described = json.loads((exported / "library.json").read_text())
    assert described["version"] == __version__
    assert all((exported / name).is_file() for name in described["headers"])
    assert f"version={__version__}" in (exported / "library.properties").read_text()
    assert f'version: "{__version__}"' in (exported / "idf_component.yml").read_text()
    module = (exported / "zephyr" / "module.yml").read_text()
    kconfig = re.search(r"kconfig: (\S+)", module)[1]
    assert "config ZERORATE" in (exported / kconfig).read_text()
    assert "@" not in "".join(p.read_text() for p in exported.rglob("*") if p.is_file())


def package(folder, **files):
    """Kernels of files by their path, its folders parted by __."""
    for name, text in files.items():
        path = folder / f"{name.replace('__', '/')}.py"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    return Kernels(folder)


@pytest.mark.parametrize(
    ("statement", "what"),
    {
        "return 1.5": "Constant",
        "return True": "Constant",
        "return a / 2": "BinOp",
        "return +a": "UnaryOp",
        "return a is s": "Compare",
        "a **= 2": "AugAssign",
        "a = s = 1": "Assign",
        "s.a = 1": "Attribute",
        "s.f()": "Call",
        "g(a=1)": "Call",
        "pass": "Pass",
        "while a: a = 0\n    else: a = 1": "While",
        "for i in range(3): a = 0\n    else: a = 1": "For",
        "for i in s: a = 0": "For",
        "for i in list(a): a = 0": "For",
        "for i in s.f(a): a = 0": "For",
        "for s[0] in range(a): a = 0": "For",
        "for i in range(): a = 0": "For",
        "for i in range(1, 2, 3, 4): a = 0": "For",
    }.items(),
)
def test_what_the_subset_does_not_have_is_refused_with_its_row(tmp_path, statement, what):
    kernels = package(tmp_path, a=f"ptr32 = 0\ndef f(s: ptr32, a: int):\n    {statement}\n")
    with pytest.raises(NotKernel, match=f"a.py: row 3: {what} is not in the kernel subset"):
        kernels_in_c(kernels, ("a", "f"))


def test_what_is_no_kernel_is_not_called_and_none_that_is_missing_is_begun_with(tmp_path):
    kernels = package(tmp_path, a="def f(a: int):\n    g(a)\ndef g(a):\n    pass\n")
    with pytest.raises(NotKernel, match="a.py: calls g, which is no kernel"):
        kernels_in_c(kernels, ("a", "f"))
    for file, name in (("a", "g"), ("b", "f")):
        with pytest.raises(NotKernel, match=f"has no kernel {name} in a file {file}.py"):
            kernels_in_c(kernels, (file, name))
