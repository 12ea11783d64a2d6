"""Ways of execution: the loops over particles and cells. The physics they call is scalar."""
