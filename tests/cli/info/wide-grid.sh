# An adaptive grid of few cells in a domain of 10^9 cells along an axis: the coefficients of its bricks would not fit into memory, which is told before the bricks are listed.
mkdir -p wide/Level_0 wide/Level_1
{
  printf 'HyperCLaw-V1.1\n1\na\n3\n0\n1\n0 0 0\n1 1 1\n2\n'
  printf '((-1000000000,0,0) (15,15,15) (0,0,0)) ((-2000000000,0,0) (31,31,31) (0,0,0))\n'
} >wide/Header
for level in 0 1; do
  box='((0,0,0) (0,0,0) (0,0,0))'
  { printf 'FAB ((8, (64 11 52 0 1 12 0 1023)),(8, (8 7 6 5 4 3 2 1)))%s 1\n' "$box" && printf '\0\0\0\0\0\0\360?'; } >wide/Level_$level/Cell_D_00000
  printf '1\n1\n1\n0\n(1 0\n%s\n)\n1\nFabOnDisk: Cell_D_00000 0\n' "$box" >wide/Level_$level/Cell_H
done
! halflight info wide --max-memory 100M
