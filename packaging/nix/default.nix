# nix-build packaging/nix builds the program and the library of this checkout.
{ pkgs ? import <nixpkgs> { } }:

pkgs.stdenv.mkDerivation {
  pname = "halflight";
  version = "0.1.0";
  src = ../..;

  nativeBuildInputs = with pkgs; [ meson ninja pkg-config ];
  buildInputs = with pkgs; [
    bzip2
    c-blosc
    cairo
    charls
    jansson
    libjpeg
    libmicrohttpd
    libpng
    libtiff
    lz4
    openexr
    openjpeg
    pango
    xz
    zlib
    zstd
  ];
  mesonFlags = [ "-Dtests=disabled" ];

  meta = {
    description = "Pictures of volumes with hard and soft shadows, without noise, on ordinary processors";
    license = pkgs.lib.licenses.asl20;
    mainProgram = "halflight";
  };
}
