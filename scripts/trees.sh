# shellcheck shell=sh
# Sourced by the scripts that try programs in other systems, and by scripts/test_python: make_tree, place_tests.

# make_tree FOLDER SUITE ARCHITECTURE PACKAGE ...: packages of a release of Debian with all that they need, unpacked and not configured.
# apt keeps its lists in the folder: nothing is installed on this machine.
make_tree() (
  tree=$1 suite=$2 architecture=$3
  shift 3
  [ ! -f "$tree/complete" ] || return 0
  mkdir -p "$tree/apt/lists/partial" "$tree/apt/archives/partial" "$tree/usr/bin" "$tree/usr/sbin" "$tree/usr/lib" "$tree/tmp" "$tree/var/tmp"
  for folder in bin sbin lib; do ln -sfn "usr/$folder" "$tree/$folder"; done
  [ "$architecture" != amd64 ] || { mkdir -p "$tree/usr/lib64"; ln -sfn usr/lib64 "$tree/lib64"; }
  echo "deb http://deb.debian.org/debian $suite main" >"$tree/apt/sources.list"
  apt_in_tree update
  apt_in_tree install -y --no-install-recommends --download-only "$@"
  for package in "$tree"/apt/archives/*.deb; do dpkg-deb --fsys-tarfile "$package" | tar -x -C "$tree" --keep-directory-symlink; done
  rm -rf "$tree/apt"
  # Links within the folder hold for whoever takes it as the root, and for qemu, which does not.
  find "$tree" -type l -lname '/*' | while read -r link; do ln -sfnr "$tree$(readlink "$link")" "$link"; done
  # What Debian's alternatives would link.
  find "$tree"/usr/lib -path '*/blas/*' -name 'lib*.so.3' -o -path '*/lapack/*' -name 'lib*.so.3' | while read -r library; do ln -sfnr "$library" "$(dirname "$library")/../$(basename "$library")"; done
  touch "$tree/complete"
)

apt_in_tree() {
  apt-get -q -o APT::Architecture="$architecture" -o APT::Architectures="$architecture" -o Dir::Etc::sourcelist="$tree/apt/sources.list" \
    -o Dir::Etc::sourceparts=/dev/null -o Dir::State="$tree/apt" -o Dir::State::status=/dev/null -o Dir::Cache="$tree/apt" \
    -o Debug::NoLocking=true -o APT::Sandbox::User=root "$@"
}

# place_tests FOLDER: the Python package's tests with all that they take from elsewhere in the sources, in FOLDER/python. What they write stays there.
place_tests() {
  rm -rf "$1/python" "$1/cli"
  mkdir -p "$1/python" "$1/cli"
  cp tests/python/*.* "$1/python"
  cp tests/cli/servers.py "$1/cli"
}
