! Tests a law against torsion.csv: Tresca's twist of the stick ratio c is arcosh(1/c)/(2 pi).
program read_torsion
  implicit none
  integer, parameter :: dp = kind(1d0)
  character(len=1000) :: line
  character(len=100) :: row(5)  ! case, given, at, radius, quantity; then the value
  real(dp) :: value, stick, lacks, largest = 0
  integer :: unit, status, tested = 0, i, comma
  open(newunit=unit, file='../tables/torsion.csv', action='read')
  do
    read(unit, '(a)', iostat=status) line
    if (status /= 0) exit
    if (line(:9) /= 'constant,') cycle
    do i = 1, 5
      comma = index(line, ','); row(i) = line(:comma - 1); line = line(comma + 1:)
    end do
    read(line(:index(line, ',') - 1), *) value
    if (row(5) == 'stick_ratio') stick = value
    if (row(5) == 'stick_complement') lacks = value
    if (row(5) /= 'twist') cycle  ! of a load it follows both
    largest = max(largest, abs(asinh(sqrt(lacks * (1 + stick)) / stick) / (2 * acos(-1d0)) / value - 1))
    tested = tested + 1
  end do
  print '(i0, a, es8.1, a)', tested, ' twists, largest relative error ', largest, ', allowed 1e-12'
  if (.not. (tested > 0 .and. largest <= 1d-12)) stop 1
end program
