"""What tests share: small fluids, fakes of engines, examples of shapes, what to ask of them."""
