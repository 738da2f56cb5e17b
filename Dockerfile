# The program viewgain and the C++ library, on Debian 12, from the packages that CPack makes:
#   docker build -t viewgain .
#   docker run --rm -v "$PWD:/data" viewgain score map.vdb --poses sphere:2000,0.6 --sensor sr4000
FROM debian:12 AS build
COPY apps/install_dependencies.sh /source/apps/
RUN apt-get update && /source/apps/install_dependencies.sh --packages && rm -rf /var/lib/apt/lists/*
COPY . /source
WORKDIR /source
RUN cmake --preset packages && cmake --build --preset packages && cd build/packages && cpack

FROM debian:12-slim
COPY --from=build /source/build/packages/packages/*.deb /packages/
# For the library in a base image of your own, add /packages/libviewgain-dev_*.deb.
RUN apt-get update \
 && apt-get install -y --no-install-recommends \
      /packages/libviewgain0.1_*.deb /packages/libviewgain-mesh0.1_*.deb /packages/viewgain_*.deb \
 && rm -rf /var/lib/apt/lists/*
WORKDIR /data
ENTRYPOINT ["viewgain"]
CMD ["--help"]
