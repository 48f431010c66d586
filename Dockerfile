# The command in an image of its own. From a checkout, and then for draws in the present folder:
#   docker build . --tag trueflight
#   docker run --rm --volume "$PWD:/work" trueflight judge --truth 0.3679 --range 0,1 draws.f64
FROM rust:1.89.0-slim-bookworm AS build
WORKDIR /trueflight
COPY . .
# With the C library inside, so that the image needs no other file.
RUN cargo rustc --profile dist --locked --bin trueflight -- -C target-feature=+crt-static

FROM scratch
COPY --from=build /trueflight/target/dist/trueflight /bin/trueflight
WORKDIR /work
USER 65534:65534
ENTRYPOINT ["/bin/trueflight"]
