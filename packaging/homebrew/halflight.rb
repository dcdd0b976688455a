# The formula of Homebrew. Addresses and the checksum are placeholders until there is a release.
class Halflight < Formula
  desc "Pictures of volumes with hard and soft shadows, without noise"
  homepage "https://example.org/halflight"
  url "https://example.org/halflight-0.1.0.tar.gz"
  sha256 "0000000000000000000000000000000000000000000000000000000000000000"
  license "Apache-2.0"

  depends_on "meson" => :build
  depends_on "ninja" => :build
  depends_on "pkgconf" => :build
  depends_on "c-blosc"
  depends_on "cairo"
  depends_on "charls"
  depends_on "jansson"
  depends_on "jpeg-turbo"
  depends_on "libmicrohttpd"
  depends_on "libpng"
  depends_on "libtiff"
  depends_on "lz4"
  depends_on "openexr"
  depends_on "openjpeg"
  depends_on "pango"
  depends_on "xz"
  depends_on "zstd"

  uses_from_macos "bzip2"
  uses_from_macos "zlib"

  def install
    system "meson", "setup", "build", "-Dtests=disabled", *std_meson_args
    system "meson", "compile", "-C", "build"
    system "meson", "install", "-C", "build"
  end

  test do
    system bin/"halflight", "make", "cloud", "--size", "32"
    system bin/"halflight", "render", "cloud.nrrd", "--size", "64x64"
    assert_path_exists testpath/"cloud.png"
  end
end
