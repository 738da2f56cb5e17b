// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Files of the component formats, from C++ and C: a sensor there and back.
#include <viewgain/formats.h>

#include <cstdio>
#include <viewgain/formats/sensor_toml.hpp>
#include <viewgain/viewgain.hpp>

int main(int, char** argv) {
  const viewgain::Sensor sensor = viewgain::sensor_preset("d435");
  viewgain::write_sensor_toml(argv[1], sensor);
  const bool same = viewgain::load_sensor(argv[1]).camera.fx == sensor.camera.fx;
  vg_sensor of_c;
  vg_sensor_init(&of_c, sizeof of_c);
  const bool read = vg_sensor_load(argv[1], &of_c) == VG_OK && of_c.fx == sensor.camera.fx;
  bool refused = false;
  try {
    (void)viewgain::read_sensor_toml("/no such file");
  } catch (const viewgain::Error&) {
    refused = true;
  }
  std::printf("%d%d%d\n", same, read, refused);
}
