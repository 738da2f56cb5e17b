// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Files of the component formats: a sensor there and back.
#include <cstdio>
#include <viewgain/formats/sensor_toml.hpp>
#include <viewgain/viewgain.hpp>

int main(int, char** argv) {
  const viewgain::Sensor sensor = viewgain::sensor_preset("d435");
  viewgain::write_sensor_toml(argv[1], sensor);
  const bool same = viewgain::load_sensor(argv[1]).camera.fx == sensor.camera.fx;
  bool refused = false;
  try {
    (void)viewgain::read_sensor_toml("/no such file");
  } catch (const viewgain::Error&) {
    refused = true;
  }
  std::printf("%d%d\n", same, refused);
}
