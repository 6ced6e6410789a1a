# SPDX-License-Identifier: Apache-2.0
# Short names for what CMake and CTest do; `make help` lists them.
SHELL := /bin/bash
.SHELLFLAGS := -eu -o pipefail -c
.DEFAULT_GOAL := help
.PHONY: help build render test test-devices asan install clean

SUNSTONE := build/release/bin/sunstone
PREFIX ?= /usr/local

help:
	@echo 'make render        build, and render scenes/first-picture to out/first-picture.png'
	@echo 'make build         the program and its tests, in build/release'
	@echo 'make test          build, and run every test that needs no download (on CPUs alone)'
	@echo "make test-devices  fetch Intel's OpenCL runtime from PyPI into build/devices (830 MB), and run the render tests on it"
	@echo 'make asan          every host test under the address and undefined-behaviour sanitizers, in build/asan'
	@echo 'make install       copy the program to PREFIX (default /usr/local; DESTDIR is respected)'
	@echo 'make clean         remove build/ and out/'

build:
	scripts/setup.sh build
	cmake --preset release
	cmake --build --preset release

render:
	scripts/setup.sh build
	cmake --preset release
	cmake --build --preset release --target sunstone sunstone_content
	mkdir -p out
	$(SUNSTONE) render scenes/first-picture/first-picture.glb --size 800x450 --spp 48 --aperture 0.006 --focus 0.63 --tone filmic -o out/first-picture.png
	@echo "The picture is $(CURDIR)/out/first-picture.png"

test:
	scripts/setup.sh test
	scripts/test.sh

test-devices:
	scripts/setup.sh devices
	cmake --preset release
	cmake --build --preset release
	scripts/test_devices.sh

asan:
	scripts/setup.sh test
	cmake --preset asan
	cmake --build --preset asan
	ctest --preset asan --no-tests=error -j2 -L 'unit|import'

install:
	scripts/setup.sh build
	cmake --preset release
	cmake --build --preset release --target sunstone sunstone_content
	cmake --install build/release --prefix '$(PREFIX)'

clean:
	rm -rf build out
